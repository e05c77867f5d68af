#include "drivers/simulated_scenario.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

namespace hitchview::drivers {
namespace {

using algo::Unit;

constexpr double kDegree = std::numbers::pi / 180;
// Positions in SimulatedRigGeometryTable.
constexpr int kFront = 0, kLeftFront = 1, kRightFront = 2, kLeft = 3, kRear = 5, kRight = 7;

/// Eight metres per second straight ahead.
SimulationOptions Straight() {
    SimulationOptions options;
    options.profile = DriveProfile::kStraight;
    return options;
}

SimulationOptions Vibration() {
    SimulationOptions options = Straight();
    options.shake[Unit::kTractor] = {.roll_pitch_rad = 0.022,
                                     .yaw_rad = 0.014,
                                     .translation_m = 0.025,
                                     .lowest_hz = 2,
                                     .highest_hz = 6};
    options.shake[Unit::kTrailer] = {.roll_pitch_rad = 0.030,
                                     .yaw_rad = 0.018,
                                     .translation_m = 0.035,
                                     .lowest_hz = 4,
                                     .highest_hz = 12};
    return options;
}

/// 14 s. No faster: at 60 degrees the tractor turns on a circle of 2.2 m.
SimulationOptions Turn(double hitch_angle_rad) {
    SimulationOptions options = Straight();
    options.frames = 420;
    options.speed = {{0, 2}, {3.5, 0.45}, {10.5, 0.45}, {14, 2}};
    options.hitch_angle = {{0.5, 0}, {6.5, hitch_angle_rad}, {7.5, hitch_angle_rad}, {13.5, 0}};
    return options;
}

SimulationOptions Reversing() {
    SimulationOptions options = Straight();
    options.speed = {{0, 0}, {1, -1.2}};
    options.hitch_angle = {{0.5, 0}, {5, 22 * kDegree}, {6.5, 20 * kDegree}, {9.5, 0}};
    return options;
}

SimulationOptions StopAndGo() {
    SimulationOptions options = Straight();
    options.speed = {{1, 8}, {3.5, 0}, {5, 0}, {8.5, 8}};
    return options;
}

/// Its front draws level with the rear of the trailer after 1.6 s and its rear with the front of
/// the tractor after 5 s.
SimulationOptions OvertakingTruck() {
    SimulationOptions options = Straight();
    options.scene.trucks = {{.start_m = -20, .across_m = 3.6, .speed_mps = options.speed_mps + 6}};
    return options;
}

SimulationOptions Night() {
    SimulationOptions options = Straight();
    options.scene.night = true;
    options.sensor.gain = 2;
    options.noise_sigma = 7;
    return options;
}

SimulationOptions Snow() {
    SimulationOptions options = Straight();
    options.speed_mps = 5;
    options.scene.ground = SceneOptions::Ground::kSnow;
    options.scene.visibility_m = 180;
    options.scene.overcast = 0.92;
    options.scene.snowflakes = 5000;
    return options;
}

/// In after about 3 s, out after about 7 s.
SimulationOptions Tunnel() {
    SimulationOptions options = Straight();
    options.speed_mps = 10;
    options.scene.tunnel = SceneOptions::Tunnel{.from_m = 30, .to_m = 70};
    options.sensor.auto_exposure = true;
    return options;
}

SimulationOptions ExposureSteps() {
    SimulationOptions options = Straight();
    options.sensor.gain_steps = {{kLeftFront, 40, 1.3},  {kLeft, 75, 0.7},  {kFront, 100, 0.75},
                                 {kRight, 130, 1.25},    {kLeft, 160, 1.2}, {kRightFront, 190, 0.7},
                                 {kLeftFront, 220, 0.8}, {kRear, 240, 1.3}, {kRight, 265, 1}};
    return options;
}

SimulationOptions TexturelessYard() {
    SimulationOptions options = Straight();
    options.speed_mps = 4;
    options.scene.ground = SceneOptions::Ground::kPlain;
    options.scene.density = 0.15;
    options.scene.overcast = 0.6;
    return options;
}

SimulationOptions CameraLost() {
    SimulationOptions options = Straight();
    options.sensor.outages = {{kLeftFront, 60, 120}, {kRight, 180, 240}};
    return options;
}

SimulationOptions Rain() {
    SimulationOptions options = Straight();
    options.scene.visibility_m = 260;
    options.scene.overcast = 0.95;
    options.scene.lens_drops = 45;
    return options;
}

/// Half a right angle to the left for each 5 s; the sun stands before the cameras next to the hitch
/// on the left after 5 s and before the front camera at the end.
SimulationOptions LowSunAhead() {
    SimulationOptions options;
    options.profile = DriveProfile::kTurnLeft;
    options.curvature_per_m = 0.02;
    options.scene.sun =
        SceneOptions::Sun{.azimuth_rad = 125 * kDegree, .elevation_rad = 11 * kDegree};
    options.sensor.auto_exposure = true;
    return options;
}

/// Comes from behind, stays level with the hitch from the third to the seventh second, goes on.
SimulationOptions TruckInOverlap() {
    SimulationOptions options = Straight();
    options.speed = {{2, 4}, {3, 8}, {7, 8}, {8, 4}};
    options.scene.trucks = {{.start_m = -10.6, .across_m = 3.6, .speed_mps = 8}};
    return options;
}

/// The engine shakes the tractor, and what it is coupled to a little.
SimulationOptions StandingStill() {
    SimulationOptions options = Straight();
    options.speed_mps = 0;
    const ShakeOptions engine{.roll_pitch_rad = 0.001,
                              .yaw_rad = 0.0003,
                              .translation_m = 0.0006,
                              .lowest_hz = 9,
                              .highest_hz = 14};
    options.shake = {{engine, engine}};
    options.shake[Unit::kTrailer].scale = 0.4;
    return options;
}

/// The trailer is coupled for 4 s.
SimulationOptions Coupling() {
    constexpr int kCoupled = 75, kUncoupled = 195, kNeverAgain = 36000;
    SimulationOptions options = Straight();
    for (int camera = kLeft; camera <= kRight; ++camera) {
        options.sensor.outages.push_back({camera, 0, kCoupled});
        options.sensor.outages.push_back({camera, kUncoupled, kNeverAgain});
    }
    return options;
}

SimulationOptions WrongCalibration() {
    SimulationOptions options;
    options.calibration.turns = {{.camera = kLeft, .yaw_rad = 3 * kDegree},
                                 {.camera = kFront, .roll_rad = 2 * kDegree}};
    options.calibration.hitch_m = 0.3;
    return options;
}

std::vector<Scenario> MakeScenarios() {
    return {
        {"straight", "straight ahead, the usual vibration", Straight()},
        {"vibration", "strong vibration, the units shaken independently", Vibration()},
        {"turn_left_60", "a turn to the left with 60 degrees at the hitch", Turn(-60 * kDegree)},
        {"turn_right_60", "a turn to the right with 60 degrees at the hitch", Turn(60 * kDegree)},
        {"reversing", "slowly backwards, the hitch angle grows and is corrected", Reversing()},
        {"slalom", "left and right in turn", SimulationOptions{}},
        {"stop_and_go", "brakes to a halt and drives on", StopAndGo()},
        {"overtaking_truck", "a truck passes on the left, 6 m/s faster", OvertakingTruck()},
        {"night", "darkness, headlights and street lamps, a noisy sensor", Night()},
        {"snow", "falling snow over white ground", Snow()},
        {"tunnel", "into a tunnel and out again, the exposure lags behind", Tunnel()},
        {"exposure_steps", "the cameras' gains jump independently", ExposureSteps()},
        {"textureless_yard", "plain grey ground with few things on it", TexturelessYard()},
        {"camera_lost", "a tractor and a trailer camera drop out for 2 s each", CameraLost()},
        {"rain", "drops on the lenses, grey sky", Rain()},
        {"low_sun", "turns through a low sun that blinds one camera after another", LowSunAhead()},
        {"truck_in_overlap", "a truck stays beside the hitch for 4 s", TruckInOverlap()},
        {"standing_still", "stands with its engine running", StandingStill()},
        {"coupling", "the trailer's cameras are there for 4 s only", Coupling()},
        {"wrong_calibration", "cameras and hitch point are not where the calibration says",
         WrongCalibration()},
    };
}

}  // namespace

std::span<const Scenario> Scenarios() {
    static const std::vector<Scenario> scenarios = MakeScenarios();
    return scenarios;
}

const Scenario* FindScenario(std::string_view name) {
    const auto scenarios = Scenarios();
    const auto found = std::find_if(scenarios.begin(), scenarios.end(),
                                    [name](const Scenario& s) { return s.name == name; });
    return found == scenarios.end() ? nullptr : &*found;
}

std::string ScenarioNames() {
    std::string names;
    for (const Scenario& scenario : Scenarios()) {
        if (!names.empty()) names += ", ";
        names += scenario.name;
    }
    return names;
}

}  // namespace hitchview::drivers
