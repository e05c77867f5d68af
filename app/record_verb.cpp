#include "app/record_verb.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/exit_code.hpp"
#include "app/report.hpp"
#include "app/run_loop.hpp"
#include "app/simulated_board.hpp"

namespace hitchview::app {
namespace {

constexpr double kSimulatedSeconds = 10;
constexpr double kMostSimulatedSeconds = 1200;

template <typename T>
void Override(const std::optional<T>& given, T& value) {
    if (given) value = *given;
}

void Override(const RecordOptions& options, RecordConfig& record) {
    record.folder = options.out;
    Override(options.segment_s, record.segment_s);
    Override(options.quota_mb, record.quota_mb);
    Override(options.min_free_mb, record.min_free_mb);
    Override(options.pre_trigger_s, record.pre_trigger_s);
    Override(options.after_trigger_s, record.after_trigger_s);
    Override(options.memory_mb, record.memory_mb);
    Override(options.quality, record.quality);
    Override(options.every, record.every);
    if (options.format)
        record.format =
            *options.format == "raw" ? RecordConfig::Format::kRaw : RecordConfig::Format::kJpeg;
}

/// A live loop has a length, whether one is given or not.
int LoopFrames(const RecordOptions& options) {
    constexpr int kUsual = 30;
    return options.live && options.loop_frames == 0 ? kUsual : options.loop_frames;
}

hal::Checked<RigConfig> LoadBoard(const RecordOptions& options) {
    if (options.board.empty()) return LoadRigConfig(options.rig);
    const double seconds = options.seconds.value_or(kSimulatedSeconds);
    if (!options.live && seconds > kMostSimulatedSeconds)
        return std::string(
            "--seconds: the simulated vehicle drives at most 1200, unless it is --live");
    const double period_s = std::chrono::duration<double>(kDefaultPeriod).count();
    const auto rig = WriteSimulatedBoard(
        {.scenario = options.scenario,
         .frames = std::max(1, static_cast<int>(std::lround(seconds / period_s))),
         .camera_width_px = options.camera_width_px,
         .loop_frames = LoopFrames(options),
         .live = options.live},
        options.out);
    if (!rig) return rig.error();
    return LoadRigConfig(rig.value());
}

RunOptions Run(const RecordOptions& options, const RigConfig& config, std::atomic<bool>& trigger) {
    RunOptions run;
    run.out = options.out;
    run.workers = options.workers;
    run.realtime = run.publish = config.IsLive();
    run.record = true;
    run.trap_alloc = options.trap_alloc;
    run.trigger = &trigger;
    if (options.seconds)
        run.duration = std::chrono::nanoseconds(std::llround(*options.seconds * 1e9));
    return run;
}

/// One line that is written again in place; silent where nobody looks.
ShownHook Progress() {
    if (isatty(STDERR_FILENO) == 0) return {};
    return [shown = 0](const ShownPanorama&, const Pipeline&) mutable {
        constexpr int kEvery = 10;
        if (++shown % kEvery == 0) std::fprintf(stderr, "\rrecorded %d frame sets", shown);
    };
}

std::string Line(const RecordingSummary& recording, const std::filesystem::path& folder) {
    std::uint64_t frames = 0;
    for (const FrameCounts& camera : recording.cameras) frames += camera.recorded;
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(),
                  ": %llu files, %.1f MB, %llu events, %llu of them camera frames; %llu dropped\n",
                  static_cast<unsigned long long>(recording.written.files),
                  static_cast<double>(recording.written.bytes) / 1e6,
                  static_cast<unsigned long long>(recording.written.events),
                  static_cast<unsigned long long>(frames),
                  static_cast<unsigned long long>(recording.dropped));
    return folder.string() + text.data();
}

bool HasFailed(const EventCounts& events) {
    for (std::size_t i = 0; i < hal::kEventCodes.size(); ++i)
        if (hal::kEventCodes[i] == hal::EventCode::kRecordingFailed) return events.happened[i] > 0;
    return false;
}

}  // namespace

int RecordVerb(const RecordOptions& options, const std::atomic<bool>& stop,
               std::atomic<bool>& trigger) {
    auto config = LoadBoard(options);
    if (!config) return Fail(kWrongUse, config.error());
    Override(options, config->record);
    const ShownHook progress = Progress();
    const auto summary =
        RunRig(config.value(), Run(options, config.value(), trigger), stop, progress);
    if (progress) std::fputc('\n', stderr);
    if (!summary) return Fail(kMachineFailed, summary.error());
    std::fputs(Table(summary.value()).c_str(), stdout);
    std::fputs(Line(*summary.value().recording, options.out).c_str(), stdout);
    const std::string refused =
        WriteJson(MakeReport(summary.value(), nullptr), options.out / "report.json");
    if (!refused.empty()) return Fail(kMachineFailed, refused);
    return HasFailed(summary.value().events) ? kMachineFailed : 0;
}

}  // namespace hitchview::app
