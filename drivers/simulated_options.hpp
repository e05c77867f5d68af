#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "algo/unit.hpp"
#include "drivers/simulated_script.hpp"
#include "drivers/simulated_sheet.hpp"
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

/// What the vehicle drives through.
struct SceneOptions {
    enum class Ground {
        kRoad,   ///< road, shoulders and meadows
        kSnow,   ///< the same under snow, with tracks
        kPlain,  ///< one grey, nearly without texture
    };
    /// A straight piece of the road under a hill, in metres along the road.
    struct Tunnel {
        double from_m = 0, to_m = 0;
    };
    /// A truck of 16 m on the road at constant speed.
    struct Truck {
        double start_m = 0;   ///< of its middle along the road as the drive starts
        double across_m = 0;  ///< left of the driven lane
        double speed_mps = 0;
    };
    /// Low enough to shine into the lenses.
    struct Sun {
        double azimuth_rad = 0;  ///< world frame, positive to the left of where the drive starts
        double elevation_rad = 0;
        double strength = 1;
    };

    Ground ground = Ground::kRoad;
    double density = 1;              ///< share of the things along the road that stand there
    double visibility_m = 900;       ///< distance at which the air hides half
    double overcast = 0;             ///< share of sky and hills that the air hides
    bool night = false;              ///< lit by headlights, work lamps and street lamps alone
    int snowflakes = 0;              ///< within three metres of each camera
    std::optional<Tunnel> tunnel{};  ///< on a straight road only
    std::vector<Truck> trucks{};
    std::optional<Sun> sun{};
    int lens_drops = 0;  ///< of rain, on each lens
};

/// What the cameras do to the light, beside the spread of their gains.
struct SensorOptions {
    /// From one frame on the gain of one camera is this times its usual one.
    struct GainStep {
        int camera = 0;
        int first_frame = 0;
        double factor = 1;
    };
    /// A camera that delivers nothing for a while.
    struct Outage {
        int camera = 0;
        int first_frame = 0;
        int end_frame = 0;  ///< the first that is there again
    };

    double gain = 1;             ///< of all cameras
    bool auto_exposure = false;  ///< follows the light around the camera, half a second behind
    std::vector<GainStep> gain_steps{};  ///< first frames ascending
    std::vector<Outage> outages{};
};

/// By how much the calibration that the pipeline is given differs from what is true.
struct CalibrationErrors {
    /// The camera is said to be turned by this beside what it is, about its own body's axes.
    struct Turn {
        int camera = 0;
        double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;
    };

    std::vector<Turn> turns{};
    double hitch_m = 0;  ///< the hitch point is said to lie so far before where the trailer has it
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
    Script speed{};        ///< m/s, negative backwards; empty: `speed_mps` throughout
    Script hitch_angle{};  ///< rad, positive left; empty: pulled. See Motion.
    algo::PerUnit<ShakeOptions> shake{
        {ShakeOptions{}, ShakeOptions{.translation_m = 0.016, .lowest_hz = 4, .highest_hz = 12}}};
    double gain_spread = 0.04;  ///< exposure gains of the cameras lie in 1 +- this
    double noise_sigma = 1.0;   ///< grey levels, of each pixel alone
    SceneOptions scene{};
    SensorOptions sensor{};
    CalibrationErrors calibration{};      ///< the pictures know nothing of it
    std::optional<SheetOptions> sheet{};  ///< held before each camera
    int render_threads = 2;               ///< threads that share one image; 1: the caller's alone
};

/// Done, or the first option out of range with its value and the range allowed.
hal::Checked<hal::Done> CheckOptions(const SimulationOptions& options);

/// Moment of frame `frame` since the start of the drive.
constexpr hal::Instant FrameTime(const SimulationOptions& options, int frame) {
    return options.period * frame;
}

}  // namespace hitchview::drivers
