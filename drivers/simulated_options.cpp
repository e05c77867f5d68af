#include "drivers/simulated_options.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace hitchview::drivers {
namespace {

/// The road of a slalom is a function of x: its heading stays well below a right angle.
constexpr double kMaxSlalomHeading_rad = 1.05;

constexpr double kMostEvents = 1000;  // of one kind in a drive
constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr double kLastCamera = 7;

struct Bound {
    const char* key;
    double value;
    double lowest;
    double highest;
};

std::string OutOfRange(const Bound& bound) {
    std::ostringstream text;
    text << "simulation: " << bound.key << " is " << bound.value << ", allowed is " << bound.lowest
         << " to " << bound.highest;
    return text.str();
}

std::vector<Bound> ShakeBounds(const ShakeOptions& shake) {
    return {{"shake.roll_pitch_rad", shake.roll_pitch_rad, 0, 0.1},
            {"shake.yaw_rad", shake.yaw_rad, 0, 0.1},
            {"shake.translation_m", shake.translation_m, 0, 0.2},
            {"shake.lowest_hz", shake.lowest_hz, 0.05, 100},
            {"shake.highest_hz", shake.highest_hz, shake.lowest_hz, 100},
            {"shake.scale", shake.scale, 0, 10}};
}

double SlalomHeading_rad(const SimulationOptions& o) {
    if (o.profile != DriveProfile::kSlalom) return 0;
    return o.curvature_per_m * o.speed_mps * o.slalom_period_s / (2 * std::numbers::pi);
}

void AddScript(std::vector<Bound>& bounds, const char* key, const Script& script, double highest) {
    bounds.push_back({"number of keys", static_cast<double>(script.size()), 0, kMostEvents});
    double last_s = 0;
    for (const Key& at : script) {
        bounds.push_back({"time_s of a key, ascending,", at.time_s, last_s, 1e5});
        bounds.push_back({key, at.value, -highest, highest});
        last_s = at.time_s + 1e-3;
    }
}

void AddScene(std::vector<Bound>& bounds, const SimulationOptions& o) {
    const SceneOptions& scene = o.scene;
    bounds.push_back({"scene.density", scene.density, 0, 1});
    bounds.push_back({"scene.visibility_m", scene.visibility_m, 20, 1e5});
    bounds.push_back({"scene.overcast", scene.overcast, 0, 1});
    bounds.push_back({"scene.snowflakes", static_cast<double>(scene.snowflakes), 0, 20000});
    bounds.push_back({"scene.trucks", static_cast<double>(scene.trucks.size()), 0, 8});
    for (const SceneOptions::Truck& truck : scene.trucks) {
        bounds.push_back({"scene.trucks.start_m", truck.start_m, -1e4, 1e4});
        bounds.push_back({"scene.trucks.across_m", truck.across_m, -20, 20});
        bounds.push_back({"scene.trucks.speed_mps", truck.speed_mps, -50, 50});
    }
    bounds.push_back({"scene.lens_drops", static_cast<double>(scene.lens_drops), 0, 1000});
    if (scene.sun) {
        bounds.push_back({"scene.sun.azimuth_rad", scene.sun->azimuth_rad, -kTurn_rad, kTurn_rad});
        bounds.push_back({"scene.sun.elevation_rad", scene.sun->elevation_rad, 0, kTurn_rad / 4});
        bounds.push_back({"scene.sun.strength", scene.sun->strength, 0, 10});
    }
    if (!scene.tunnel) return;
    const double from_m = scene.tunnel->from_m;
    bounds.push_back({"scene.tunnel with profile", static_cast<double>(o.profile), 0, 0});
    bounds.push_back({"scene.tunnel.from_m", from_m, -1e4, 1e4});
    bounds.push_back({"scene.tunnel.to_m", scene.tunnel->to_m, from_m + 10, from_m + 1e4});
}

void AddSensor(std::vector<Bound>& bounds, const SensorOptions& sensor) {
    bounds.push_back({"sensor.gain", sensor.gain, 0.1, 10});
    bounds.push_back(
        {"number of gain_steps", static_cast<double>(sensor.gain_steps.size()), 0, kMostEvents});
    bounds.push_back(
        {"number of outages", static_cast<double>(sensor.outages.size()), 0, kMostEvents});
    for (const SensorOptions::GainStep& step : sensor.gain_steps) {
        bounds.push_back({"sensor.gain_steps.camera", 1.0 * step.camera, 0, kLastCamera});
        bounds.push_back({"sensor.gain_steps.first_frame", 1.0 * step.first_frame, 0, 36000});
        bounds.push_back({"sensor.gain_steps.factor", step.factor, 0.1, 10});
    }
    for (const SensorOptions::Outage& outage : sensor.outages) {
        bounds.push_back({"sensor.outages.camera", 1.0 * outage.camera, 0, kLastCamera});
        bounds.push_back({"sensor.outages.first_frame", 1.0 * outage.first_frame, 0, 36000});
    }
}

void AddCalibration(std::vector<Bound>& bounds, const CalibrationErrors& errors) {
    constexpr double kMostTurned_rad = 0.5;
    bounds.push_back({"calibration.hitch_m", errors.hitch_m, -2, 2});
    for (const CalibrationErrors::Turn& turn : errors.turns) {
        bounds.push_back({"calibration.turns.camera", 1.0 * turn.camera, 0, kLastCamera});
        for (const double angle_rad : {turn.roll_rad, turn.pitch_rad, turn.yaw_rad})
            bounds.push_back(
                {"angle of calibration.turns", angle_rad, -kMostTurned_rad, kMostTurned_rad});
    }
}

std::vector<Bound> Bounds(const SimulationOptions& o) {
    std::vector<Bound> bounds{
        {"frames", static_cast<double>(o.frames), 1, 36000},
        {"period_ns", static_cast<double>(o.period.count()), 1e6, 1e9},
        {"width_px", static_cast<double>(o.width_px), 32, 4096},
        {"height_px", static_cast<double>(o.height_px), 16, static_cast<double>(o.width_px)},
        {"width_px modulo 2", static_cast<double>(o.width_px % 2), 0, 0},
        {"height_px modulo 2", static_cast<double>(o.height_px % 2), 0, 0},
        {"speed_mps", o.speed_mps, 0, 30},
        {"curvature_per_m", o.curvature_per_m, 0.001, 0.5},
        {"slalom_period_s", o.slalom_period_s, 0.5, 120},
        {"slalom heading_rad", SlalomHeading_rad(o), 0, kMaxSlalomHeading_rad},
        {"gain_spread", o.gain_spread, 0, 0.5},
        {"noise_sigma", o.noise_sigma, 0, 50},
        {"render_threads", static_cast<double>(o.render_threads), 1, 64}};
    for (const ShakeOptions& shake : o.shake.of) {
        const std::vector<Bound> more = ShakeBounds(shake);
        bounds.insert(bounds.end(), more.begin(), more.end());
    }
    AddScript(bounds, "speed", o.speed, 30);
    AddScript(bounds, "hitch_angle", o.hitch_angle, 1.4);
    AddScene(bounds, o);
    AddSensor(bounds, o.sensor);
    AddCalibration(bounds, o.calibration);
    return bounds;
}

}  // namespace

hal::Checked<hal::Done> CheckOptions(const SimulationOptions& options) {
    const std::vector<Bound> bounds = Bounds(options);
    const auto bad = std::find_if(bounds.begin(), bounds.end(), [](const Bound& bound) {
        return !(bound.value >= bound.lowest && bound.value <= bound.highest);  // catches NaN too
    });
    if (bad != bounds.end()) return OutOfRange(*bad);
    return hal::Done{};
}

}  // namespace hitchview::drivers
