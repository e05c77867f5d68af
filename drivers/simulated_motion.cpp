#include "drivers/simulated_motion.hpp"

#include <cmath>
#include <numbers>

#include "drivers/simulated_noise.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::chrono::milliseconds kGrid{10};
constexpr double kTwoPi = 2 * std::numbers::pi;

double Seconds(hal::Instant instant) {
    return std::chrono::duration<double>(instant).count();
}

double SlalomLength_m(const SimulationOptions& o) {
    return o.speed_mps * o.slalom_period_s;
}

Isometry3d Planar(double x_m, double y_m, double yaw_rad) {
    Isometry3d T = Isometry3d::Identity();
    T.translate(Vector3d{x_m, y_m, VehicleDimensions::kHitchHeight});
    T.rotate(AngleAxisd(yaw_rad, Vector3d::UnitZ()));
    return T;
}

/// `T_world_unit` with the unit displaced by `shake` at its axle, `axle_x_m` ahead of the hitch.
Isometry3d Displaced(const Isometry3d& T_world_unit, const Isometry3d& shake, double axle_x_m) {
    const Eigen::Translation3d to_axle(axle_x_m, 0, 0);
    return T_world_unit * to_axle * shake * to_axle.inverse();
}

}  // namespace

double HeadingAt(const SimulationOptions& o, double travelled_m) {
    switch (o.profile) {
        case DriveProfile::kStraight:
            return 0;
        case DriveProfile::kTurnLeft:
            return o.curvature_per_m * travelled_m;
        case DriveProfile::kTurnRight:
            return -o.curvature_per_m * travelled_m;
        case DriveProfile::kSlalom:
            break;
    }
    const double length_m = SlalomLength_m(o);
    if (length_m <= 0) return 0;
    return -o.curvature_per_m * length_m / kTwoPi * std::cos(kTwoPi * travelled_m / length_m);
}

double CurvatureAt(const SimulationOptions& o, double travelled_m) {
    switch (o.profile) {
        case DriveProfile::kStraight:
            return 0;
        case DriveProfile::kTurnLeft:
            return o.curvature_per_m;
        case DriveProfile::kTurnRight:
            return -o.curvature_per_m;
        case DriveProfile::kSlalom:
            break;
    }
    const double length_m = SlalomLength_m(o);
    return length_m <= 0 ? 0 : o.curvature_per_m * std::sin(kTwoPi * travelled_m / length_m);
}

double SteadyHitchAngle(double curvature_per_m) {
    const double ak = VehicleDimensions::kTractorAxle * curvature_per_m;
    const double bk = VehicleDimensions::kTrailerAxle * curvature_per_m;
    return -(std::atan(ak) + std::asin(bk / std::hypot(1.0, ak)));
}

Shake::Shake(const ShakeOptions& options, std::uint32_t seed) : channels_{} {
    Dice dice(seed);
    const double sine_of_rms = options.scale * std::sqrt(2.0 / kSines);
    const double band_hz = (options.highest_hz - options.lowest_hz) / kSines;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        const double rms = c < 3    ? options.translation_m
                           : c == 5 ? options.yaw_rad
                                    : options.roll_pitch_rad;
        for (int i = 0; i < kSines; ++i) {  // one sine in each part of the band
            const double hz = options.lowest_hz + band_hz * (i + dice.Between(0, 1));
            channels_[c][static_cast<std::size_t>(i)] = {rms * sine_of_rms, kTwoPi * hz,
                                                         dice.Between(0, kTwoPi)};
        }
    }
}

double Shake::Sum(const Channel& channel, double time_s) {
    double sum = 0;
    for (const Sine& sine : channel) {
        sum += sine.amplitude * std::sin(sine.rate_rad_s * time_s + sine.phase_rad);
    }
    return sum;
}

Isometry3d Shake::At(double time_s) const {
    const auto channel = [&](std::size_t c) { return Sum(channels_[c], time_s); };
    Isometry3d T = Isometry3d::Identity();
    T.translate(Vector3d{channel(0), channel(1), channel(2)});
    T.rotate(AngleAxisd(channel(5), Vector3d::UnitZ()) * AngleAxisd(channel(4), Vector3d::UnitY()) *
             AngleAxisd(channel(3), Vector3d::UnitX()));
    return T;
}

Motion::Motion(const SimulationOptions& options)
    : options_(options),
      shakes_{{Shake(options.shake[algo::Unit::kTractor], Hash(options.seed, 101)),
               Shake(options.shake[algo::Unit::kTrailer], Hash(options.seed, 202))}} {
    const hal::Instant end = FrameTime(options, options.frames) + std::chrono::seconds(1);
    const auto steps = static_cast<std::size_t>(end / kGrid) + 1;
    states_.reserve(steps);
    State state;
    if (!options.hitch_angle.empty()) state.hitch_rad = ValueAt(options.hitch_angle, 0);
    for (std::size_t i = 0; i < steps; ++i) {
        states_.push_back(state);
        state = Step(state, Seconds(kGrid) * static_cast<double>(i), Seconds(kGrid));
    }
}

double Motion::SpeedAt(double time_s) const {
    return options_.speed.empty() ? options_.speed_mps : ValueAt(options_.speed, time_s);
}

double Motion::TractorYaw(const State& state) const {
    return options_.hitch_angle.empty() ? HeadingAt(options_, state.travelled_m) : state.yaw_rad;
}

Motion::State Motion::Slope(const State& s, double time_s) const {
    if (!options_.hitch_angle.empty()) return ScriptedSlope(s, time_s);
    const double speed = SpeedAt(time_s);
    const double k = CurvatureAt(options_, s.travelled_m);
    const double heading = HeadingAt(options_, s.travelled_m);
    const double pulled =
        std::sin(s.hitch_rad) + VehicleDimensions::kTractorAxle * k * std::cos(s.hitch_rad);
    return {speed * std::cos(heading), speed * std::sin(heading), speed,
            -speed / VehicleDimensions::kTrailerAxle * pulled - speed * k};
}

Motion::State Motion::ScriptedSlope(const State& s, double time_s) const {
    constexpr double kA = VehicleDimensions::kTractorAxle;
    constexpr double kB = VehicleDimensions::kTrailerAxle;
    const double speed = SpeedAt(time_s);
    const double angle = ValueAt(options_.hitch_angle, time_s);
    const double angle_rate = RateAt(options_.hitch_angle, time_s);
    const double yaw_rate =
        -(kB * angle_rate + speed * std::sin(angle)) / (kA * std::cos(angle) + kB);
    return {speed * std::cos(s.yaw_rad), speed * std::sin(s.yaw_rad), speed, angle_rate, yaw_rate};
}

// Runge-Kutta, fourth order.
Motion::State Motion::Step(const State& state, double time_s, double duration_s) const {
    const auto after = [&state](const State& slope, double seconds) {
        return State{state.x_m + slope.x_m * seconds, state.y_m + slope.y_m * seconds,
                     state.travelled_m + slope.travelled_m * seconds,
                     state.hitch_rad + slope.hitch_rad * seconds,
                     state.yaw_rad + slope.yaw_rad * seconds};
    };
    const double half_s = duration_s / 2;
    const State k1 = Slope(state, time_s);
    const State k2 = Slope(after(k1, half_s), time_s + half_s);
    const State k3 = Slope(after(k2, half_s), time_s + half_s);
    const State k4 = Slope(after(k3, duration_s), time_s + duration_s);
    const auto mean = [&](double State::*part) {
        return (k1.*part + 2 * k2.*part + 2 * k3.*part + k4.*part) / 6;
    };
    return after({mean(&State::x_m), mean(&State::y_m), mean(&State::travelled_m),
                  mean(&State::hitch_rad), mean(&State::yaw_rad)},
                 duration_s);
}

Motion::State Motion::StateAt(hal::Instant since_start) const {
    const auto i = static_cast<std::size_t>(since_start / kGrid);
    HV_EXPECT(since_start.count() >= 0 && i < states_.size());
    return Step(states_[i], Seconds(kGrid) * static_cast<double>(i), Seconds(since_start % kGrid));
}

Isometry3d Motion::PoseAt(hal::Instant since_start, algo::Unit unit, Shaking shaking) const {
    const State state = StateAt(since_start);
    const double tractor_yaw = TractorYaw(state);
    const bool tractor = unit == algo::Unit::kTractor;
    const Isometry3d T_world_unit =
        Planar(state.x_m - VehicleDimensions::kTractorAxle * std::cos(tractor_yaw),
               state.y_m - VehicleDimensions::kTractorAxle * std::sin(tractor_yaw),
               tractor ? tractor_yaw : tractor_yaw + state.hitch_rad);
    if (shaking == Shaking::kWithout) return T_world_unit;
    return Displaced(T_world_unit, shakes_[unit].At(Seconds(since_start)),
                     tractor ? VehicleDimensions::kTractorAxle : -VehicleDimensions::kTrailerAxle);
}

std::vector<Eigen::Vector2d> Motion::PathOffRoad() const {
    constexpr double kApart_m = 0.5;
    std::vector<Eigen::Vector2d> path;
    if (options_.hitch_angle.empty()) return path;
    for (const State& state : states_) {
        const Eigen::Vector2d p_m{state.x_m, state.y_m};
        if (path.empty() || (p_m - path.back()).norm() > kApart_m) path.push_back(p_m);
    }
    return path;
}

double Motion::HitchAngleAt(hal::Instant since_start) const {
    return StateAt(since_start).hitch_rad;
}

}  // namespace hitchview::drivers
