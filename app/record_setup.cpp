#include "app/record_setup.hpp"

#include <algorithm>
#include <fstream>

#include "app/log_channels.hpp"
#include "app/publish_options.hpp"
#include "app/recording_publisher.hpp"
#include "drivers/lcm_url.hpp"

namespace hitchview::app {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;

std::string Text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<RecordedCamera> CamerasOf(const RigConfig& config, Board& board) {
    std::vector<RecordedCamera> cameras;
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < config.units[unit].cameras.size(); ++i) {
            const std::string& name = config.units[unit].cameras[i].name;
            cameras.push_back({.name = name,
                               .channel = CameraChannel(name),
                               .format = board.cameras()[unit][i]->format(),
                               .tap = board.taps().at(cameras.size())});
        }
    }
    return cameras;
}

/// Empty, or which camera cannot have a channel of its own.
std::string Problem(const RigConfig& config, const std::vector<RecordedCamera>& cameras) {
    for (const RecordedCamera& camera : cameras) {
        const std::string where = config.file.string() + ": camera " + camera.name + ": ";
        if (const auto channel = drivers::CheckLcmChannel("channel", camera.channel); !channel)
            return where + channel.error();
        if (std::ranges::count(cameras, camera.channel, &RecordedCamera::channel) > 1)
            return where + "its channel " + camera.channel + " must be its own: rename one";
    }
    return "";
}

drivers::RecordedRig RigOf(const RigConfig& config, const RunSummary& run,
                           const std::vector<RecordedCamera>& cameras) {
    drivers::RecordedRig rig{.rig_yaml = Text(config.file),
                             .calibration_id = run.calibration_id,
                             .period_ms = run.period_ms * config.record.every};
    if (!config.calibration.empty()) rig.calibration_yaml = Text(config.calibration);
    for (const RecordedCamera& camera : cameras) {
        rig.cameras.push_back(camera.name);
        rig.camera_channels.push_back(camera.channel);
    }
    return rig;
}

RecorderOptions OptionsOf(const RigConfig& config, const RunOptions& options) {
    const RecordConfig& record = config.record;
    RecorderOptions recorder{
        .folder = {.folder = record.folder,
                   .quota_bytes = kMegabyte * static_cast<std::uint64_t>(record.quota_mb),
                   .min_free_bytes = kMegabyte * static_cast<std::uint64_t>(record.min_free_mb)},
        .segment = std::chrono::seconds(record.segment_s),
        .pre_trigger = std::chrono::seconds(record.pre_trigger_s),
        .after_trigger = std::chrono::seconds(record.after_trigger_s),
        .trigger_by = record.trigger,
        .intake = {.memory_bytes = static_cast<std::size_t>(record.memory_mb) << 20,
                   .lossless = !options.realtime,
                   .live = config.IsLive()},
        .frames = {.threads = record.threads,
                   .raw = record.format == RecordConfig::Format::kRaw,
                   .quality = record.quality,
                   .every = static_cast<std::uint32_t>(record.every)},
        .trigger = options.trigger};
    const bool named = config.can && !config.can->interface.empty();
    if (named) recorder.intake.can_bus = config.can->interface;
    return recorder;
}

}  // namespace

hal::Checked<std::unique_ptr<Recorder>> OpenRecorder(const RigConfig& config,
                                                     const RunOptions& options,
                                                     const RunSummary& run, Board& board) {
    if (!options.record || config.record.folder.empty()) return std::unique_ptr<Recorder>();
    std::vector<RecordedCamera> cameras = CamerasOf(config, board);
    if (std::string problem = Problem(config, cameras); !problem.empty()) return problem;
    const drivers::RecordedRig rig = RigOf(config, run, cameras);
    return Recorder::Open(OptionsOf(config, options), rig, std::move(cameras), board.clock(),
                          board.events());
}

hal::Checked<std::unique_ptr<hal::Publisher>> OpenRecordingPublisher(const PublishConfig& config,
                                                                     const hal::Clock& clock,
                                                                     Recorder& recorder) {
    auto encoder = drivers::LcmEncoder::Create(EncoderOptionsOf(config), clock);
    if (!encoder) return encoder.error();
    return std::unique_ptr<hal::Publisher>(
        std::make_unique<RecordingPublisher>(std::move(*encoder), recorder));
}

}  // namespace hitchview::app
