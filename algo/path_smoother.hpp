#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace hitchview::algo {

inline constexpr int kMaxLookahead = 10;  ///< frames

struct PathSmootherOptions {
    int lookahead_frames = 0;             ///< 0..kMaxLookahead
    int horizon_frames = 20;              ///< beyond the frames seen, filled by the guess
    double guess_damping = 0.85;          ///< of the velocity, per frame of the horizon
    double velocity_smoothing = 0.15;     ///< share of the newest motion in the velocity guess
    double weakest_pull = 1e-5;           ///< pull to the path far from the wall
    double strongest_pull = 1.0;          ///< at the wall
    Eigen::Vector3d wall{1e9, 1e9, 1e9};  ///< bound of |offset|, per component
    double free_share = 0.4;              ///< of the wall where the pull starts to grow
};

/// Causal smoothing of one path of three components. Each step minimises, over a receding horizon,
///     sum_t (x_t - 2 x_{t-1} + x_{t-2})^2 + pull sum_t (x_t - T_t)^2
/// with the two outputs emitted last fixed, the path T known for the lookahead frames and guessed
/// beyond them (damped constant velocity). That is a fixed set of taps per pull. The pull grows
/// smoothly as an offset nears its wall; beyond it the offset is cut. State: offsets S = x - T and
/// the velocity; no absolute path, so nothing drifts.
class PathSmoother {
 public:
    explicit PathSmoother(const PathSmootherOptions& options);

    /// What is known when frame t is emitted; relative to the path at t.
    struct Window {
        Eigen::Vector3d early_output;                      ///< x_{t-1} - T_t
        Eigen::Vector3d earlier_output;                    ///< x_{t-2} - T_t
        Eigen::Vector3d motion;                            ///< T_t - T_{t-1}
        std::array<Eigen::Vector3d, kMaxLookahead> ahead;  ///< T_{t+j} - T_t, j = 1..lookahead
    };

    /// The offset S_t.
    Eigen::Vector3d Next(const Window& window);
    void Reset();

    /// The bound that is in force for |offset|.
    [[nodiscard]] const Eigen::Vector3d& wall() const { return options_.wall; }

 private:
    /// S_t = early a + earlier b + sum_j ahead_j c_j + velocity d.
    struct Taps {
        double early;
        double earlier;
        double velocity;
        std::array<double, kMaxLookahead> ahead;
    };
    static constexpr int kPulls = 48;

    [[nodiscard]] Taps Solve(double pull) const;
    [[nodiscard]] double Apply(const Taps& taps, const Window& window, int component) const;

    PathSmootherOptions options_;
    std::array<Taps, kPulls> taps_;
    Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d demand_ = Eigen::Vector3d::Zero();
};

}  // namespace hitchview::algo
