#include "app/simulated_devices.hpp"

#include <algorithm>

#include "app/camera_ahead.hpp"
#include "app/placed_camera.hpp"
#include "app/simulated_loop.hpp"
#include "drivers/looped_camera.hpp"
#include "drivers/simulated_camera.hpp"
#include "drivers/simulated_can_bus.hpp"
#include "drivers/simulated_scenario.hpp"

namespace hitchview::app {
namespace {

drivers::DriveProfile Profile(SimulationConfig::Profile profile) {
    switch (profile) {
        case SimulationConfig::Profile::kStraight:
            return drivers::DriveProfile::kStraight;
        case SimulationConfig::Profile::kSlalom:
            return drivers::DriveProfile::kSlalom;
        case SimulationConfig::Profile::kTurnLeft:
            return drivers::DriveProfile::kTurnLeft;
        case SimulationConfig::Profile::kTurnRight:
            return drivers::DriveProfile::kTurnRight;
    }
    return drivers::DriveProfile::kStraight;
}

/// A course or speed that is given stands in place of the scenario's own.
void ApplyDrive(const SimulationConfig& config, drivers::SimulationOptions& options) {
    if (config.profile) {
        options.profile = Profile(*config.profile);
        options.hitch_angle.clear();
    }
    if (config.speed_mps) {
        options.speed_mps = *config.speed_mps;
        options.speed.clear();
    }
}

/// Of the drive that is there to be rendered: a loop of its first frames has its own length.
int DriveFrames(const SimulationConfig& config, int of_scenario) {
    if (config.loop_frames) return std::max(of_scenario, *config.loop_frames);
    return config.frames.value_or(of_scenario);
}

drivers::SimulationOptions Overridden(drivers::SimulationOptions options,
                                      const SimulationConfig& config, hal::Instant period) {
    options.seed = config.seed.value_or(options.seed);
    options.frames = DriveFrames(config, options.frames);
    options.render_threads = 1;  // each camera is rendered on a thread of its own
    options.period = period;
    if (config.camera_size_px) {
        options.width_px = config.camera_size_px->width_px;
        options.height_px = config.camera_size_px->height_px;
    }
    ApplyDrive(config, options);
    options.noise_sigma = config.noise.value_or(options.noise_sigma);
    for (const algo::Unit unit : algo::kUnits) {
        options.shake[unit].scale = config.shake[unit].value_or(options.shake[unit].scale);
    }
    return options;
}

/// Index in the simulated rig; -1 for a name it does not have on that unit.
int IndexOf(const drivers::SimulatedRig& rig, algo::Unit unit, const std::string& name) {
    for (int i = 0; i < drivers::SimulatedRig::kCameras; ++i) {
        const auto& camera = rig.camera(i);
        if (camera.name == name && camera.unit == unit) return i;
    }
    return -1;
}

/// Of the cameras that the simulated rig has.
std::vector<int> IndicesOf(const drivers::SimulatedRig& rig, const RigConfig& config) {
    std::vector<int> indices;
    for (const PlacedCamera& camera : CamerasOf(config)) {
        if (camera.config->source != CameraConfig::Source::kSimulated) continue;
        const int index = IndexOf(rig, camera.unit, camera.config->name);
        if (index >= 0) indices.push_back(index);
    }
    return indices;
}

bool IsNeeded(const RigConfig& config) {
    if (config.can && config.can->source == CanConfig::Source::kSimulated) return true;
    return std::ranges::any_of(CamerasOf(config), [](const PlacedCamera& camera) {
        return camera.config->source == CameraConfig::Source::kSimulated;
    });
}

}  // namespace

hal::Checked<std::unique_ptr<SimulatedDevices>> SimulatedDevices::Open(
    const RigConfig& config, const drivers::SheetOptions* held_sheet,
    std::unique_ptr<SimulatedDevices> earlier) {
    if (!IsNeeded(config)) return std::unique_ptr<SimulatedDevices>{};
    const std::string& name = config.simulation.scenario;
    const drivers::Scenario* scenario = drivers::FindScenario(name);
    if (scenario == nullptr) {
        return config.file.string() + ": simulation.scenario is " + name + ", must be one of " +
               drivers::ScenarioNames();
    }
    auto options =
        Overridden(scenario->options, config.simulation, config.period.value_or(kDefaultPeriod));
    if (held_sheet != nullptr) options.sheet = *held_sheet;
    auto rig = drivers::SimulatedRig::Create(options);
    if (!rig) return config.file.string() + ": simulation: " + rig.error();
    std::unique_ptr<drivers::LoopedFrames> loop;
    if (earlier) loop = std::move(earlier->loop_);
    const auto& looped = config.simulation.loop_frames;
    if (looped && !loop) loop = RenderLoop(**rig, IndicesOf(**rig, config), *looped);
    return std::unique_ptr<SimulatedDevices>(
        new SimulatedDevices(config, std::move(*rig), std::move(loop)));
}

SimulatedDevices::SimulatedDevices(const RigConfig& config,
                                   std::unique_ptr<drivers::SimulatedRig> rig,
                                   std::unique_ptr<drivers::LoopedFrames> loop)
    : file_(config.file.string()),
      config_(config.simulation),
      rig_(std::move(rig)),
      loop_(std::move(loop)) {}

hal::Checked<std::unique_ptr<hal::Camera>> SimulatedDevices::OpenCamera(algo::Unit unit,
                                                                        const std::string& name,
                                                                        int slots) const {
    const auto index = Find(unit, name);
    if (!index) return index.error();
    std::unique_ptr<hal::Camera> camera;
    if (loop_) {
        camera = std::make_unique<drivers::LoopedCamera>(
            *loop_, drivers::LoopedCameraOptions{.camera = index.value(),
                                                 .period = rig_->options().period,
                                                 .frames = static_cast<std::uint32_t>(RunFrames()),
                                                 .slots = slots});
    } else {
        camera = std::make_unique<drivers::SimulatedCamera>(*rig_, index.value(), hal::Instant{0},
                                                            slots);
    }
    return std::unique_ptr<hal::Camera>(std::make_unique<CameraAhead>(std::move(camera), name));
}

hal::Checked<std::unique_ptr<hal::Camera>> SimulatedDevices::OpenLiveCamera(
    algo::Unit unit, const std::string& name, int slots, hal::Instant start,
    hal::Clock& clock) const {
    const auto index = Find(unit, name);
    if (!index) return index.error();
    const drivers::LoopedCameraOptions options{
        .camera = index.value(), .period = rig_->options().period, .start = start, .slots = slots};
    return std::unique_ptr<hal::Camera>(
        std::make_unique<drivers::LoopedLiveCamera>(*loop_, options, clock));
}

std::unique_ptr<hal::CanBus> SimulatedDevices::OpenCanBus(hal::Clock& clock) const {
    drivers::SimulatedCanOptions options{.frames = RunFrames(),
                                         .loop_frames = config_.loop_frames.value_or(0)};
    if (config_.live) {
        options.start = clock.Now();
        options.clock = &clock;
    }
    return std::make_unique<drivers::SimulatedCanBus>(*rig_, options);
}

hal::Checked<int> SimulatedDevices::Find(algo::Unit unit, const std::string& name) const {
    const int index = IndexOf(*rig_, unit, name);
    if (index >= 0) return index;
    return file_ + ": camera " + name + " of the " + ToString(unit) +
           " is not one that the simulated rig has (tractor: front, left_front, right_front; "
           "trailer: left, left_rear, rear, right_rear, right)";
}

/// Until the end, unless it is live.
int SimulatedDevices::RunFrames() const {
    return config_.frames.value_or(rig_->options().frames);
}

}  // namespace hitchview::app
