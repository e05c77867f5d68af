#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace hitchview::algo {

/// A scene point that one camera of a unit sees in two neighbouring frames; frame of the unit.
struct SightMotion {
    Eigen::Vector3d early;     ///< direction, of unit length
    Eigen::Vector3d late;      ///< direction, of unit length
    Eigen::Vector3d origin_m;  ///< the camera's centre of projection
};

struct TurnFitOptions {
    double px_per_rad = 326;      ///< in what follows, px are angles times this
    double first_spread_px = 8;   ///< of the errors that are believed in the first step
    double spread_px = 0.6;       ///< and in the last one
    double parallax_rad = 0.15;   ///< usual motion of things beside the unit as it drives on
    double parallax_turn = 0.15;  ///< rad; how far parallax may point beside where it should
    double translation_m = 0.15;  ///< deviation of a frame's translation from the usual one
    double max_deviation_px = 3;  ///< a turn that is less certain is none
    double usual_translation_gain = 0.1;
    int steps = 12;
};

struct Turn {
    Eigen::Matrix3d R_late_early;
    int inliers;          ///< sights that agree with the turn and some distance
    double deviation_px;  ///< standard deviation about the least certain axis
};

/// How a unit that drives has turned between two frames. A scene point at distance D from a camera
/// at c moves from direction f to
///     g ~ R f + tau / D,   tau = t + R c - c,
/// and D is unknown. So what lies across the image of tau (the epipolar line of R f) tells of the
/// turn, whatever the distance; what lies along it does only as far as the point may be far. A fit
/// of R alone takes the parallax of whatever has texture, say the lit side of a road, for a turn.
/// Unknowns are R and t; robust weights whose scale shrinks from step to step (graduated
/// non-convexity), Gauss-Newton. State: the usual t. Takes no memory.
class TurnFit {
 public:
    explicit TurnFit(const TurnFitOptions& options);

    void Reset();
    /// `R_start`: right to some `first_spread_px`. Empty if the sights do not determine the turn.
    std::optional<Turn> Fit(std::span<const SightMotion> sights, const Eigen::Matrix3d& R_start);

 private:
    struct Errors;
    struct Normal;

    std::optional<Errors> Measure(const SightMotion& sight) const;
    void Add(const SightMotion& sight, double spread_px, Normal& normal) const;
    void AddUsualTranslation(Normal& normal) const;
    void Step(const Normal& normal);
    [[nodiscard]] double Spread(int step) const;

    TurnFitOptions options_;
    Eigen::Vector3d usual_t_m_;
    Eigen::Matrix3d R_;
    Eigen::Vector3d t_m_;
};

}  // namespace hitchview::algo
