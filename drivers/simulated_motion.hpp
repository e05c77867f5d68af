#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "drivers/simulated_options.hpp"

namespace hitchview::drivers {

/// Lengths of the vehicle, metres; 4.5 x 1.5 x 1.8 overall.
struct VehicleDimensions {
    static constexpr double kFront = 2.0;  ///< hitch to front of tractor
    static constexpr double kRear = 2.5;   ///< hitch to rear of trailer
    static constexpr double kHalfWidth = 0.75;
    static constexpr double kHitchHeight = 0.4;  ///< hitch above ground
    static constexpr double kTractorAxle = 0.6;  ///< hitch to rear axle of tractor
    static constexpr double kTrailerAxle = 1.6;  ///< hitch to axle of trailer
};

enum class Shaking { kWithout, kWith };

/// Heading of the road and of the tractor's rear axle after `travelled_m`. World frame: x along the
/// middle of the drive, z up, origin on the ground where the rear axle of the tractor starts.
double HeadingAt(const SimulationOptions& options, double travelled_m);
/// Derivative of HeadingAt, 1/m, positive to the left.
double CurvatureAt(const SimulationOptions& options, double travelled_m);
/// Hitch angle that a constant curvature leads to, with a = kTractorAxle and b = kTrailerAxle:
///     angle = -(atan(a k) + asin(b k / sqrt(1 + a^2 k^2)))
double SteadyHitchAngle(double curvature_per_m);

/// Band-limited motion with six degrees of freedom: a sum of sines, so that any moment is known
/// without the moments before it.
class Shake {
 public:
    Shake(const ShakeOptions& options, std::uint32_t seed);
    /// Displacement of the axle, in coordinates of the unit.
    [[nodiscard]] Eigen::Isometry3d At(double time_s) const;

 private:
    static constexpr int kSines = 6;
    struct Sine {
        double amplitude, rate_rad_s, phase_rad;
    };
    using Channel = std::array<Sine, kSines>;
    [[nodiscard]] static double Sum(const Channel& channel, double time_s);

    std::array<Channel, 6> channels_;  // x, y, z, roll, pitch, yaw
};

/// Where both units are at any moment of the drive. The tractor's rear axle follows the road; the
/// trailer is pulled without side slip (v speed, k curvature, a, b as in SteadyHitchAngle):
///     d(angle)/dt = -v / b (sin(angle) + a k cos(angle)) - v k
/// With a scripted hitch angle the tractor leaves the road and steers just so that the trailer,
/// still without side slip, takes that angle; the same equation, solved for the yaw rate v k:
///     d(yaw)/dt = -(b d(angle)/dt + v sin(angle)) / (a cos(angle) + b)
/// It is stable backwards too. Thread-safe.
class Motion {
 public:
    explicit Motion(const SimulationOptions& options);

    /// T_world_unit; origin in the hitch point. `since_start` from 0 to one second past the last
    /// frame.
    [[nodiscard]] Eigen::Isometry3d PoseAt(hal::Instant since_start, algo::Unit unit,
                                           Shaking shaking) const;
    /// Yaw of the trailer relative to the tractor, positive to the left, without shaking.
    [[nodiscard]] double HitchAngleAt(hal::Instant since_start) const;
    /// Places of the hitch on the drive, less than a metre apart, where it leaves the road.
    [[nodiscard]] std::vector<Eigen::Vector2d> PathOffRoad() const;

 private:
    struct State {
        double x_m = 0, y_m = 0, travelled_m = 0, hitch_rad = 0;
        double yaw_rad = 0;  // of the tractor, where the hitch angle is scripted
    };
    [[nodiscard]] double SpeedAt(double time_s) const;
    [[nodiscard]] double TractorYaw(const State& state) const;
    [[nodiscard]] State Slope(const State& state, double time_s) const;
    [[nodiscard]] State ScriptedSlope(const State& state, double time_s) const;
    [[nodiscard]] State Step(const State& state, double time_s, double duration_s) const;
    [[nodiscard]] State StateAt(hal::Instant since_start) const;

    SimulationOptions options_;
    algo::PerUnit<Shake> shakes_;
    std::vector<State> states_;  // every kGrid
};

}  // namespace hitchview::drivers
