#pragma once

#include <Eigen/Core>
#include <array>

namespace hitchview::algo {

inline constexpr int kMaxLookahead = 10;  ///< frames

struct PathSmootherOptions {
    int lookahead_frames = 0;             ///< 0..kMaxLookahead
    int horizon_frames = 27;              ///< beyond the frames seen, guessed; 1..kMaxHorizon
    double guess_damping = 0.95;          ///< of the velocity, per frame of the horizon
    double velocity_smoothing = 1;        ///< share of the newest motion in the guess's velocity
    double weakest_pull = 7e-6;           ///< pull to the path far from the wall
    double strongest_pull = 0.19;         ///< at the wall
    double free_share = 0.28;             ///< of the wall, where the pull starts to grow
    Eigen::Vector3d wall{1e9, 1e9, 1e9};  ///< bound of |offset|, per component
    double wall_stiffness = 0;            ///< weight of what a planned offset exceeds its wall by
    double guessed_wall_share = 1;        ///< of the wall, for frames that are a guess
    Eigen::Vector2d turn_takes_px{0, 0};  ///< of the walls of x and y, per unit of component 2
    static constexpr int kMaxHorizon = 32;
};

/// Causal smoothing of one path of three components. Each step plans the outputs x over a receding
/// horizon, to minimise
///     sum_t (x_t - 2 x_{t-1} + x_{t-2})^2 + pull sum_t (x_t - T_t)^2
///         + wall_stiffness sum_t max(0, |x_t - T_t| - wall_t)^2
/// with the two outputs emitted last fixed, the path T known for the lookahead frames and guessed
/// beyond them (damped constant velocity), and emits the first one, cut at the wall. The pull grows
/// as the offset nears its wall. State: the velocity and the demand for pull; offsets S = x - T
/// come from outside, there is no absolute path, so nothing drifts.
class PathSmoother {
 public:
    explicit PathSmoother(const PathSmootherOptions& options);

    /// What is known when frame t is emitted; relative to the path at t.
    struct Window {
        Eigen::Vector3d early_output = Eigen::Vector3d::Zero();    ///< x_{t-1} - T_t
        Eigen::Vector3d earlier_output = Eigen::Vector3d::Zero();  ///< x_{t-2} - T_t
        Eigen::Vector3d motion = Eigen::Vector3d::Zero();          ///< T_t - T_{t-1}
        std::array<Eigen::Vector3d, kMaxLookahead> ahead;  ///< T_{t+j} - T_t, j = 1..lookahead
    };

    /// The offset S_t.
    Eigen::Vector3d Next(const Window& window);
    void Reset();

 private:
    static constexpr int kMaxPlan = 1 + kMaxLookahead + PathSmootherOptions::kMaxHorizon;
    using Planned = std::array<double, kMaxPlan>;

    void UpdateVelocity(const Window& window);
    double UpdatePull(double early_offset, int component);
    void GuessPath(const Window& window, int component);
    void SetWall(int component);
    void Plan(double early, double earlier, double pull);
    bool FindExceeded();

    PathSmootherOptions options_;
    int frames_;  // planned
    Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d demand_ = Eigen::Vector3d::Zero();

    // of the component that is being planned
    Planned path_{};
    Planned wall_{};
    Planned output_{};
    std::array<int, kMaxPlan> exceeded_{};  // -1, 0, 1: the wall on which side
    Planned turn_{};                        // planned offset of component 2
};

}  // namespace hitchview::algo
