#pragma once

#include <chrono>
#include <cstdint>

#include "algo/unit.hpp"
#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// What the driver does. The road follows the drive.
enum class DriveProfile {
    kStraight,
    kSlalom,     ///< curvature swings between both signs of `curvature_per_m`
    kTurnLeft,   ///< constant curvature
    kTurnRight,  ///< constant curvature
};

/// Random motion of one unit about its own axle. Amplitudes are root mean squares.
struct ShakeOptions {
    double roll_pitch_rad = 0.0105;
    double yaw_rad = 0.007;
    double translation_m = 0.012;
    double lowest_hz = 2;
    double highest_hz = 6;
    double scale = 1;  ///< multiplies every amplitude; 0 holds the unit still
};

/// Everything that decides what the simulated cameras and CAN bus deliver. Equal options, equal
/// bytes.
struct SimulationOptions {
    std::uint32_t seed = 1;
    int frames = 300;
    std::chrono::nanoseconds period{33'333'333};
    int width_px = 1280;  ///< even; the lens keeps its 120 degrees, the intrinsics scale
    int height_px = 720;  ///< even, at most `width_px`
    double speed_mps = 8;
    DriveProfile profile = DriveProfile::kSlalom;
    double curvature_per_m = 0.08;  ///< peak of the slalom, constant in a turn
    double slalom_period_s = 6;
    algo::PerUnit<ShakeOptions> shake{
        {ShakeOptions{}, ShakeOptions{.translation_m = 0.016, .lowest_hz = 4, .highest_hz = 12}}};
    double gain_spread = 0.04;  ///< exposure gains of the cameras lie in 1 +- this
    double noise_sigma = 1.0;   ///< grey levels, of each pixel alone
    int render_threads = 2;     ///< threads that share one image; 1: the caller's alone
};

/// Done, or the first option out of range with its value and the range allowed.
hal::Checked<hal::Done> CheckOptions(const SimulationOptions& options);

/// Moment of frame `frame` since the start of the drive.
constexpr hal::Instant FrameTime(const SimulationOptions& options, int frame) {
    return options.period * frame;
}

}  // namespace hitchview::drivers
