#include "app/board.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "app/camera_ahead.hpp"
#include "app/faulty_camera.hpp"
#include "app/live_camera_options.hpp"
#include "app/log_replay.hpp"
#include "app/publish_options.hpp"
#include "app/simulated_loop.hpp"
#include "app/tapped_camera.hpp"
#include "drivers/candump_can_bus.hpp"
#include "drivers/lcm_log_camera.hpp"
#include "drivers/lcm_log_can_bus.hpp"
#include "drivers/lcm_publisher.hpp"
#include "drivers/lcm_receive_buffer.hpp"
#include "drivers/looped_camera.hpp"
#include "drivers/replay_camera.hpp"
#include "drivers/simulated_camera.hpp"
#include "drivers/simulated_can_bus.hpp"
#include "drivers/simulated_scenario.hpp"
#include "drivers/socketcan_bus.hpp"
#include "drivers/steady_clock.hpp"
#include "drivers/systemd_journal.hpp"
#include "drivers/systemd_notify.hpp"
#include "drivers/v4l2_camera.hpp"

namespace hitchview::app {
namespace {

/// Frames that a decoder may be ahead of the reader, or that wait for the set they are of.
constexpr int kFramesAhead = 4;

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

/// Buffers that a live camera is given. `slots`: frames that the program may hold; `taps`: of these
/// for its recorder, which a number that the rig file states does not count.
int BuffersOf(const LiveCameraConfig& live, int slots, int taps) {
    constexpr int kWithTheDevice = 3;
    constexpr int kMost = 32;
    return live.buffers > 0 ? std::min(live.buffers + taps, kMost) : slots + kWithTheDevice;
}

/// The live cameras of a rig while they are opened.
class LiveOpening {
 public:
    struct Opened {
        std::unique_ptr<hal::Camera> camera;  ///< null: it is not there
        const drivers::V4l2Camera* v4l2 = nullptr;
        drivers::V4l2CameraOptions options{};
        drivers::V4l2Refusal refusal{};  ///< why it is not there
    };

    LiveOpening(double rate_hz, int slots, int taps)
        : rate_hz_(rate_hz), slots_(slots), taps_(taps) {}

    /// The error: it never will be there.
    hal::Checked<hal::Done> Add(const CameraConfig& camera) {
        const int buffers = BuffersOf(camera.live, slots_, taps_);
        Opened& place = opened_.emplace_back();
        if (camera.source == CameraConfig::Source::kLibcamera) {
            auto opened = drivers::OpenLibcamera(
                LibcameraOptionsOf(camera.name, camera.live, rate_hz_, buffers));
            if (!opened) return opened.error();
            place.camera = std::move(*opened);
            return hal::Done{};
        }
        place.options = V4l2OptionsOf(camera.name, camera.live, rate_hz_, buffers);
        auto opened = drivers::V4l2Camera::TryOpen(place.options);
        if (!opened) place.refusal = opened.error();
        if (!opened && place.refusal.is_wish_wrong) return place.refusal.words;
        if (!opened) return hal::Done{};
        place.v4l2 = opened->get();
        place.camera = std::move(*opened);
        return hal::Done{};
    }

    /// Places of those that are not there.
    [[nodiscard]] std::vector<std::size_t> Absent() const {
        std::vector<std::size_t> absent;
        for (std::size_t i = 0; i < opened_.size(); ++i)
            if (!opened_[i].camera) absent.push_back(i);
        return absent;
    }
    [[nodiscard]] const std::string& WhyAbsent(std::size_t i) const {
        return opened_[i].refusal.words;
    }
    /// Has those that are not there awaited by what the others are like.
    void AwaitAbsent() {
        std::vector<const drivers::V4l2Camera*> there;
        for (const Opened& opened : opened_)
            if (opened.v4l2 != nullptr) there.push_back(opened.v4l2);
        for (const std::size_t i : Absent()) {
            Opened& absent = opened_[i];
            absent.camera =
                drivers::V4l2Camera::Await(absent.options, absent.refusal.failure, there);
        }
    }
    [[nodiscard]] std::unique_ptr<hal::Camera> Take(std::size_t i) {
        return std::move(opened_[i].camera);
    }

 private:
    double rate_hz_;
    int slots_;
    int taps_;
    std::vector<Opened> opened_;
};

/// A camera of a rig and where it is.
struct PlacedCamera {
    const CameraConfig* config;
    algo::Unit unit;
    std::size_t index_in_unit;
};

std::vector<PlacedCamera> CamerasOf(const RigConfig& config) {
    std::vector<PlacedCamera> cameras;
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < config.units[unit].cameras.size(); ++i)
            cameras.push_back({&config.units[unit].cameras[i], unit, i});
    }
    return cameras;
}

std::string CameraError(const RigConfig& config, const CameraConfig& camera,
                        const std::string& why) {
    return config.file.string() + ": camera " + camera.name + ": " + why;
}

/// Index in the simulated rig; -1 for a name it does not have on that unit.
int SimulatedIndex(const drivers::SimulatedRig& rig, algo::Unit unit, const std::string& name) {
    for (int i = 0; i < drivers::SimulatedRig::kCameras; ++i) {
        const auto& camera = rig.camera(i);
        if (camera.name == name && camera.unit == unit) return i;
    }
    return -1;
}

std::string NoSuchCamera(const RigConfig& config, algo::Unit unit, const std::string& name) {
    return config.file.string() + ": camera " + name + " of the " + ToString(unit) +
           " is not one that the simulated rig has (tractor: front, left_front, right_front; "
           "trailer: left, left_rear, rear, right_rear, right)";
}

/// Frames until the end, unless it is live.
int RunFrames(const RigConfig& config, const drivers::SimulatedRig& rig) {
    return config.simulation.frames.value_or(rig.options().frames);
}

/// Of the cameras that the simulated rig has.
std::vector<int> SimulatedIndices(const drivers::SimulatedRig& rig, const RigConfig& config) {
    std::vector<int> indices;
    for (const PlacedCamera& camera : CamerasOf(config)) {
        if (camera.config->source != CameraConfig::Source::kSimulated) continue;
        const int index = SimulatedIndex(rig, camera.unit, camera.config->name);
        if (index >= 0) indices.push_back(index);
    }
    return indices;
}

}  // namespace

Board::Board(const Options& options)
    : options_(options),
      clock_(std::make_unique<drivers::SteadyClock>()),
      event_log_(drivers::SystemdJournal::Open(std::getenv("JOURNAL_STREAM"))),
      events_(event_log_.get()) {}
Board::~Board() = default;

hal::Checked<std::unique_ptr<Board>> Board::Open(const RigConfig& config, const Options& options,
                                                 std::unique_ptr<Board> earlier) {
    std::unique_ptr<Board> board(new Board(options));
    if (earlier) board->loop_ = std::move(earlier->loop_);
    earlier.reset();
    const int slots = options.held_frames + kFramesAhead + (options.recorded ? FrameTap::kHeld : 0);
    if (config.period) board->period_ = *config.period;
    if (const auto simulated = board->OpenSimulation(config); !simulated) return simulated.error();
    board->is_live_ = config.IsLive();
    if (config.IsLive()) {
        const auto opened = board->OpenLiveCameras(config, slots);
        if (!opened) return opened.error();
    } else {
        for (const PlacedCamera& camera : CamerasOf(config)) {
            const auto opened = board->OpenCamera(config, camera.unit, *camera.config, slots);
            if (!opened) return opened.error();
        }
    }
    if (board->period_.count() == 0) board->period_ = kDefaultPeriod;
    if (const auto can = board->OpenCanBus(config); !can) return can.error();
    board->StartSets(config);
    return board;
}

hal::Checked<hal::Done> Board::OpenSimulation(const RigConfig& config) {
    bool needed = config.can && config.can->source == CanConfig::Source::kSimulated;
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : config.units[unit].cameras) {
            needed = needed || camera.source == CameraConfig::Source::kSimulated;
        }
    }
    if (!needed) return hal::Done{};
    const std::string& name = config.simulation.scenario;
    const drivers::Scenario* scenario = drivers::FindScenario(name);
    if (scenario == nullptr) {
        return config.file.string() + ": simulation.scenario is " + name + ", must be one of " +
               drivers::ScenarioNames();
    }
    auto options =
        Overridden(scenario->options, config.simulation, config.period.value_or(kDefaultPeriod));
    if (options_.held_sheet != nullptr) options.sheet = *options_.held_sheet;
    auto rig = drivers::SimulatedRig::Create(options);
    if (!rig) return config.file.string() + ": simulation: " + rig.error();
    simulation_ = std::move(*rig);
    const auto& looped = config.simulation.loop_frames;
    if (looped && !loop_)
        loop_ = RenderLoop(*simulation_, SimulatedIndices(*simulation_, config), *looped);
    return hal::Done{};
}

hal::Checked<hal::Done> Board::OpenCamera(const RigConfig& config, algo::Unit unit,
                                          const CameraConfig& camera, int slots) {
    if (camera.source == CameraConfig::Source::kLog) {
        OpenLogCamera(config, unit, camera, slots);
        return hal::Done{};
    }
    if (camera.source == CameraConfig::Source::kSimulated) {
        const int index = SimulatedIndex(*simulation_, unit, camera.name);
        if (index < 0) return NoSuchCamera(config, unit, camera.name);
        Add(unit, camera.name, OpenSimulatedCamera(config, camera.name, index, slots));
        return hal::Done{};
    }
    // Where the rig file states the pace, the frames were captured at it.
    const double rate_hz = config.period ? 1e9 / static_cast<double>(config.period->count()) : 0;
    auto replay = drivers::ReplayCamera::Open(
        camera.replay.string(), {.name = camera.name, .rate_hz = rate_hz, .slots = slots});
    if (!replay) return config.file.string() + ": camera " + camera.name + ": " + replay.error();
    if (period_.count() == 0)
        period_ = hal::Instant(static_cast<std::int64_t>(1e9 / (*replay)->rate_hz()));
    Add(unit, camera.name, std::move(*replay));
    return hal::Done{};
}

std::unique_ptr<hal::Camera> Board::OpenSimulatedCamera(const RigConfig& config,
                                                        const std::string& name, int index,
                                                        int slots) {
    std::unique_ptr<hal::Camera> camera;
    if (loop_) {
        camera = std::make_unique<drivers::LoopedCamera>(
            *loop_, drivers::LoopedCameraOptions{
                        .camera = index,
                        .period = simulation_->options().period,
                        .frames = static_cast<std::uint32_t>(RunFrames(config, *simulation_)),
                        .slots = slots});
    } else {
        camera =
            std::make_unique<drivers::SimulatedCamera>(*simulation_, index, hal::Instant{0}, slots);
    }
    return std::make_unique<CameraAhead>(std::move(camera), name);
}

std::unique_ptr<hal::Camera> Board::WithFaults(const std::string& name,
                                               std::unique_ptr<hal::Camera> camera) {
    if (options_.faults == nullptr) return camera;
    std::vector<CameraFault> faults = options_.faults->Of(name);
    if (faults.empty()) return camera;
    const FaultyCamera::Pace pace{.clock = is_live_ ? clock_.get() : nullptr,
                                  .period = period_.count() > 0 ? period_ : kDefaultPeriod};
    return std::make_unique<FaultyCamera>(std::move(camera), std::move(faults), pace,
                                          options_.held_frames + kFramesAhead +
                                              (options_.recorded ? FrameTap::kHeld : 0));
}

hal::Camera& Board::Add(algo::Unit unit, const std::string& name,
                        std::unique_ptr<hal::Camera> camera) {
    camera = WithFaults(name, std::move(camera));
    if (options_.recorded) {
        auto tapped = std::make_unique<TappedCamera>(std::move(camera));
        taps_.push_back(&tapped->tap());
        camera = std::move(tapped);
    }
    return *cameras_[unit].emplace_back(std::move(camera));
}

hal::Checked<hal::Done> Board::OpenLiveSimulation(const RigConfig& config, int slots) {
    const hal::Instant start = clock_->Now();
    for (const auto& [camera, unit, index_in_unit] : CamerasOf(config)) {
        const int index = SimulatedIndex(*simulation_, unit, camera->name);
        if (index < 0) return NoSuchCamera(config, unit, camera->name);
        const drivers::LoopedCameraOptions options{
            .camera = index, .period = period_, .start = start, .slots = slots};
        auto opened = std::make_unique<drivers::LoopedLiveCamera>(*loop_, options, *clock_);
        live_cameras_.push_back(
            {&Add(unit, camera->name, std::move(opened)), camera->name, unit, index_in_unit});
    }
    return hal::Done{};
}

hal::Checked<hal::Done> Board::OpenLiveCameras(const RigConfig& config, int slots) {
    if (period_.count() == 0) period_ = kDefaultPeriod;
    if (config.simulation.live) return OpenLiveSimulation(config, slots);
    const int taps = options_.recorded ? FrameTap::kHeld : 0;
    LiveOpening opening(1e9 / static_cast<double>(period_.count()), slots, taps);
    const std::vector<PlacedCamera> cameras = CamerasOf(config);
    for (const PlacedCamera& camera : cameras) {
        const auto added = opening.Add(*camera.config);
        if (!added) return CameraError(config, *camera.config, added.error());
    }
    const std::vector<std::size_t> absent = opening.Absent();
    const bool starts = options_.awaits_cameras && absent.size() < cameras.size();
    for (const std::size_t i : absent) {
        const std::string why = CameraError(config, *cameras[i].config, opening.WhyAbsent(i));
        if (!starts) return why;
        std::fprintf(stderr, "%s; it is awaited\n", why.c_str());
        cameras_awaited_ |= 1U << i;
    }
    opening.AwaitAbsent();
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const auto& [camera, unit, index] = cameras[i];
        live_cameras_.push_back({&Add(unit, camera->name, opening.Take(i)), camera->name, unit, index});
    }
    return hal::Done{};
}

void Board::OpenLogCamera(const RigConfig& config, algo::Unit unit, const CameraConfig& camera,
                          int slots) {
    auto logged = std::make_unique<drivers::LcmLogCamera>(drivers::LcmLogCameraOptions{
        .files = config.log.recordings[camera.log.recording],
        .kind = {.format = camera.log.format, .compressed = camera.log.compressed},
        .slots = slots});
    drivers::LcmLogCamera* const source = logged.get();
    const std::size_t index = cameras_[unit].size();
    hal::Camera& ahead =
        Add(unit, camera.name, std::make_unique<CameraAhead>(std::move(logged), camera.name));
    log_cameras_.push_back({.config = camera.log,
                            .name = camera.name,
                            .source = source,
                            .camera = &ahead,
                            .unit = unit,
                            .index_in_unit = index});
}

void Board::StartSets(const RigConfig& config) {
    if (!log_cameras_.empty()) {
        sets_ = std::make_unique<LogReplay>(config, period_, log_cameras_, log_can_bus_);
        return;
    }
    if (live_cameras_.empty()) {
        sets_ = std::make_unique<RecordedFrameSynchronizer>(cameras_);
        return;
    }
    auto live = std::make_unique<LiveFrameSynchronizer>(live_cameras_, events_, *clock_, period_,
                                                        config.set_tolerance.value_or(period_));
    live_ = live.get();
    sets_ = std::move(live);
}

hal::Checked<hal::Done> Board::OpenCanBus(const RigConfig& config) {
    if (!config.can) return hal::Done{};
    if (config.can->source == CanConfig::Source::kSimulated) {
        OpenSimulatedCan(config);
        return hal::Done{};
    }
    if (config.can->source == CanConfig::Source::kSocketCan) return OpenSocketCan(config);
    if (config.can->source == CanConfig::Source::kLog) {
        auto logged = std::make_unique<drivers::LcmLogCanBus>();
        log_can_bus_ = logged.get();
        can_bus_ = std::move(logged);
        return hal::Done{};
    }
    auto bus = drivers::CandumpCanBus::Open(config.can->candump.string(), hal::Instant{0});
    if (!bus) return bus.error();
    can_bus_ = std::move(*bus);
    return hal::Done{};
}

void Board::OpenSimulatedCan(const RigConfig& config) {
    drivers::SimulatedCanOptions options{.frames = RunFrames(config, *simulation_),
                                         .loop_frames = config.simulation.loop_frames.value_or(0)};
    if (config.simulation.live) {
        options.start = clock_->Now();
        options.clock = clock_.get();
        is_can_live_ = true;
    }
    can_bus_ = std::make_unique<drivers::SimulatedCanBus>(*simulation_, options);
}

hal::Checked<hal::Done> Board::OpenSocketCan(const RigConfig& config) {
    const HitchAngleSignal& signal = config.can->hitch_angle;
    drivers::SocketCanOptions options{.interface = config.can->interface,
                                      .record = options_.recorded,
                                      .receive_buffer_bytes = config.can->receive_buffer_bytes};
    if (!options_.recorded) options.ids = {{.id = signal.id, .extended = signal.IsExtended()}};
    auto bus = drivers::SocketCanBus::Open(options);
    if (!bus) return config.file.string() + ": can.source.socketcan: " + bus.error();
    if (!(*bus)->remark().empty()) std::fprintf(stderr, "%s\n", (*bus)->remark().c_str());
    can_bus_ = std::move(*bus);
    is_can_live_ = true;
    return hal::Done{};
}

CameraFormats Board::formats() const {
    CameraFormats formats;
    for (const algo::Unit unit : algo::kUnits) {
        for (const auto& camera : cameras_[unit]) formats[unit].push_back(camera->format());
    }
    return formats;
}

hal::Checked<std::unique_ptr<hal::Publisher>> Board::OpenPublisher(const PublishConfig& config) {
    auto publisher = drivers::LcmPublisher::Create(
        {.url = config.url, .messages = EncoderOptionsOf(config)}, *clock_);
    if (!publisher) return publisher.error();
    return std::unique_ptr<hal::Publisher>(std::move(*publisher));
}

hal::Checked<std::unique_ptr<hal::Watchdog>> Board::OpenWatchdog() {
    return drivers::SystemdNotify::Open(std::getenv("NOTIFY_SOCKET"));
}

std::optional<int> Board::ReceiveBufferBytes() {
    const auto buffers = drivers::ReadSocketBuffers();
    if (!buffers) return std::nullopt;
    return buffers->largest_bytes;
}

}  // namespace hitchview::app
