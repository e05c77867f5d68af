#include "app/log_rig.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/log_channels.hpp"
#include "app/log_recording.hpp"
#include "app/log_survey.hpp"
#include "app/log_time.hpp"

namespace hitchview::app {
namespace {

namespace fs = std::filesystem;
using Source = CameraConfig::Source;

/// A rig_t, and when its recording begins.
struct RigOfLog {
    std::int64_t start_us = 0;
    bool found = false;
    NamedText rig{};
    NamedText calibration{};
    std::string calibration_id{};
    std::vector<std::string> cameras{};
    std::vector<std::string> channels{};
    double period_ms = 0;
};

void Keep(const drivers::LoggedRig& logged, const std::string& file, RigOfLog& rig) {
    rig.found = true;
    rig.rig = {file + " (rig file)", std::string(logged.rig_yaml)};
    rig.calibration = {file + " (calibration)", std::string(logged.calibration_yaml)};
    rig.calibration_id = logged.calibration_id;
    rig.cameras.assign(logged.cameras.begin(), logged.cameras.end());
    rig.channels.assign(logged.camera_channels.begin(), logged.camera_channels.end());
    rig.period_ms = logged.period_ms;
}

/// The first rig_t. Where another rig is given it only names channels: it is not sought for long.
hal::Checked<RigOfLog> FindRig(const std::vector<fs::path>& files, bool other_given,
                               const std::atomic<bool>& stop) {
    constexpr int kShortSearch = 500;
    LogRecording recording(files, stop);
    RigOfLog rig;
    auto event = recording.Next();
    if (event) rig.start_us = event.value().utime_us;
    for (int i = 0; event && !rig.found && !(other_given && i >= kShortSearch); ++i) {
        if (drivers::KindOf(event.value().data) == drivers::LoggedKind::kRig) {
            const auto logged = drivers::ParseLoggedRig(event.value().data);
            if (logged) Keep(logged.value(), files[recording.file()].string(), rig);
        }
        event = recording.Next();
    }
    if (!event && event.error() != hal::Error::kEndOfStream) return recording.failure();
    return rig;
}

/// The rig file of the recording with its calibration.
hal::Checked<RigConfig> RecordedRig(const RigOfLog& logged, const fs::path& folder) {
    auto config = ParseRigConfig(logged.rig, folder);
    if (!config || config->calibration.empty()) return config;
    if (logged.calibration.text.empty())
        return logged.rig.name + ": the recording has no calibration, which this rig needs";
    config->calibration_text = logged.calibration;
    const auto calibration = LoadCalibrationFor(config.value());
    if (!calibration) return calibration.error();
    const std::string id = calibration.value().id();
    if (id != logged.calibration_id)
        return logged.calibration.name + ": its id is " + id + ", must be " +
               logged.calibration_id + ", which the recording states";
    config->log.calibration_id = id;
    return config;
}

hal::Checked<RigConfig> RigFor(const LogRigOptions& options, const RigOfLog& logged,
                               const std::vector<fs::path>& files) {
    if (!options.rig.empty()) return LoadRigConfig(options.rig);
    if (!logged.found)
        return files.front().string() +
               ": no rig is recorded in it: say with --rig which cameras it has";
    return RecordedRig(logged, files.front().parent_path());
}

std::string ChannelOf(const std::string& camera, const RigOfLog& logged) {
    const auto named = std::ranges::find(logged.cameras, camera);
    if (named == logged.cameras.end()) return CameraChannel(camera);
    return logged.channels[static_cast<std::size_t>(named - logged.cameras.begin())];
}

/// Cameras and CAN bus are the recording's.
void Connect(const RigOfLog& logged, RigConfig& config) {
    for (const algo::Unit unit : algo::kUnits) {
        for (CameraConfig& camera : config.units[unit].cameras) {
            camera.source = Source::kLog;
            camera.log.channel = ChannelOf(camera.name, logged);
        }
    }
    if (config.can) config.can->source = CanConfig::Source::kLog;
    if (!config.period && logged.period_ms >= 1 && logged.period_ms <= 1000)
        config.period = std::chrono::nanoseconds(std::llround(logged.period_ms * 1e6));
}

hal::Checked<hal::Done> ApplySpan(const LogRigOptions& options, std::int64_t start_us,
                                  LogConfig& log) {
    const auto read = [&](const std::string& text, const char* option,
                          auto& out) -> hal::Checked<hal::Done> {
        if (text.empty()) return hal::Done{};
        const auto utime_us = ParseLogTime(text, start_us);
        if (!utime_us)
            return std::string(option) + " is " + text +
                   ", must be seconds since the start or a time such as 2026-11-22T19:51:39.5Z";
        out = *utime_us;
        return hal::Done{};
    };
    if (const auto from = read(options.from, "--from", log.from_us); !from) return from;
    if (const auto to = read(options.to, "--to", log.to_us); !to) return to;
    if (log.to_us && *log.to_us <= log.from_us)
        return "--to is " + options.to + ", must be later than --from";
    return hal::Done{};
}

bool IsLog(const CameraConfig& camera) {
    return camera.source == Source::kReplay && !camera.ReadsPictures();
}

/// Gives the camera its log's channel; each log is one recording.
hal::Checked<hal::Done> Connect(CameraConfig& camera, std::vector<fs::path>& logs, LogConfig& log) {
    auto known = std::ranges::find(logs, camera.replay);
    if (known == logs.end()) {
        auto files = LogFiles({camera.replay});
        if (!files) return "camera " + camera.name + ": " + files.error();
        log.recordings.push_back(std::move(*files));
        known = logs.insert(logs.end(), camera.replay);
    }
    camera.source = Source::kLog;
    camera.log = {.recording = static_cast<std::size_t>(known - logs.begin()),
                  .channel = CameraChannel(camera.name)};
    return hal::Done{};
}

}  // namespace

hal::Checked<RigConfig> LoadLogRig(const LogRigOptions& options, const std::atomic<bool>& stop) {
    auto files = LogFiles(options.logs);
    if (!files) return files.error();
    const auto logged = FindRig(files.value(), !options.rig.empty(), stop);
    if (!logged) return logged.error();
    auto config = RigFor(options, logged.value(), files.value());
    if (!config) return config;
    Connect(logged.value(), config.value());
    const auto span = ApplySpan(options, logged.value().start_us, config->log);
    if (!span) return span.error();
    config->log.recordings = {std::move(*files)};
    if (const auto known = SurveyLogs(config.value(), stop); !known) return known.error();
    return config;
}

hal::Checked<RigConfig> ResolveLogs(const RigConfig& config, const std::atomic<bool>& stop) {
    std::size_t cameras = 0;
    std::size_t logs = 0;
    for (const algo::Unit unit : algo::kUnits) {
        cameras += config.units[unit].cameras.size();
        logs += static_cast<std::size_t>(std::ranges::count_if(config.units[unit].cameras, IsLog));
    }
    if (logs == 0) return config;
    if (logs != cameras)
        return config.file.string() +
               ": units: must have cameras that all replay LCM logs, or none";
    RigConfig resolved = config;
    std::vector<fs::path> known;
    for (const algo::Unit unit : algo::kUnits) {
        for (CameraConfig& camera : resolved.units[unit].cameras) {
            const auto connected = Connect(camera, known, resolved.log);
            if (!connected) return config.file.string() + ": " + connected.error();
        }
    }
    if (const auto surveyed = SurveyLogs(resolved, stop); !surveyed) return surveyed.error();
    return resolved;
}

}  // namespace hitchview::app
