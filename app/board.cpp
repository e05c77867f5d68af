#include "app/board.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

#include "app/camera_ahead.hpp"
#include "app/faulty_camera.hpp"
#include "app/live_opening.hpp"
#include "app/log_replay.hpp"
#include "app/placed_camera.hpp"
#include "app/publish_options.hpp"
#include "app/simulated_devices.hpp"
#include "app/tapped_camera.hpp"
#include "drivers/candump_can_bus.hpp"
#include "drivers/lcm_log_camera.hpp"
#include "drivers/lcm_log_can_bus.hpp"
#include "drivers/lcm_publisher.hpp"
#include "drivers/lcm_receive_buffer.hpp"
#include "drivers/replay_camera.hpp"
#include "drivers/socketcan_bus.hpp"
#include "drivers/steady_clock.hpp"
#include "drivers/systemd_journal.hpp"
#include "drivers/systemd_notify.hpp"

namespace hitchview::app {
namespace {

/// Frames that a decoder may be ahead of the reader, or that wait for the set they are of.
constexpr int kFramesAhead = 4;

/// Frames of a camera that the program may hold.
int SlotsOf(const Board::Options& options) {
    return options.held_frames + kFramesAhead + (options.recorded ? FrameTap::kHeld : 0);
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
    std::unique_ptr<SimulatedDevices> shown_before;
    if (earlier) shown_before = std::move(earlier->simulation_);
    earlier.reset();
    const int slots = SlotsOf(options);
    if (config.period) board->period_ = *config.period;
    auto simulation = SimulatedDevices::Open(config, options.held_sheet, std::move(shown_before));
    if (!simulation) return simulation.error();
    board->simulation_ = std::move(*simulation);
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

hal::Checked<hal::Done> Board::OpenCamera(const RigConfig& config, algo::Unit unit,
                                          const CameraConfig& camera, int slots) {
    if (camera.source == CameraConfig::Source::kLog) {
        OpenLogCamera(config, unit, camera, slots);
        return hal::Done{};
    }
    if (camera.source == CameraConfig::Source::kSimulated) {
        auto opened = simulation_->OpenCamera(unit, camera.name, slots);
        if (!opened) return opened.error();
        Add(unit, camera.name, std::move(*opened));
        return hal::Done{};
    }
    // Where the rig file states the pace, the frames were captured at it.
    const double rate_hz = config.period ? 1e9 / static_cast<double>(config.period->count()) : 0;
    auto replay = drivers::ReplayCamera::Open(
        camera.replay.string(), {.name = camera.name, .rate_hz = rate_hz, .slots = slots});
    if (!replay) return CameraError(config, camera, replay.error());
    if (period_.count() == 0)
        period_ = hal::Instant(static_cast<std::int64_t>(1e9 / (*replay)->rate_hz()));
    Add(unit, camera.name, std::move(*replay));
    return hal::Done{};
}

std::unique_ptr<hal::Camera> Board::WithFaults(const std::string& name,
                                               std::unique_ptr<hal::Camera> camera) {
    if (options_.faults == nullptr) return camera;
    std::vector<CameraFault> faults = options_.faults->Of(name);
    if (faults.empty()) return camera;
    const FaultyCamera::Pace pace{.clock = is_live_ ? clock_.get() : nullptr,
                                  .period = period_.count() > 0 ? period_ : kDefaultPeriod};
    return std::make_unique<FaultyCamera>(std::move(camera), std::move(faults), pace,
                                          SlotsOf(options_));
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
        auto opened = simulation_->OpenLiveCamera(unit, camera->name, slots, start, *clock_);
        if (!opened) return opened.error();
        live_cameras_.push_back(
            {&Add(unit, camera->name, std::move(*opened)), camera->name, unit, index_in_unit});
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
        live_cameras_.push_back(
            {&Add(unit, camera->name, opening.Take(i)), camera->name, unit, index});
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
        can_bus_ = simulation_->OpenCanBus(*clock_);
        is_can_live_ = config.simulation.live;
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
