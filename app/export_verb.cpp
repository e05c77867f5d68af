#include "app/export_verb.hpp"

#include <cstdio>
#include <optional>

#include "app/evaluation_statistics.hpp"
#include "app/exit_code.hpp"
#include "app/log_export.hpp"
#include "app/log_progress.hpp"
#include "app/log_time.hpp"

namespace hitchview::app {
namespace {

using drivers::LoggedKind;

/// Empty, or the file of the recording that would be overwritten.
std::filesystem::path Overwritten(const ExportOptions& options,
                                  const std::vector<std::filesystem::path>& files) {
    std::error_code failed;
    for (const auto& out : {options.mp4, options.candump, options.mcap, options.csv})
        for (const auto& file : files)
            if (std::filesystem::equivalent(out, file, failed)) return file;
    return {};
}

/// From one picture to the next: the middle of the first hundred; empty if there are not two.
std::optional<double> PicturePeriod_ms(LogRecording& recording, const PictureChoice& choice) {
    constexpr std::size_t kEnough = 100;
    LogChannels channels;
    std::optional<hal::Instant> early;
    std::vector<double> periods;
    while (periods.size() < kEnough) {
        const auto event = recording.Next();
        if (!event) break;
        if (!choice.Means(event.value(), channels.KindOf(event.value()))) continue;
        const auto image = drivers::ParseLoggedImage(event.value().data);
        if (!image) continue;
        const hal::Instant utime = std::chrono::microseconds(image.value().utime_us);
        const hal::Instant late = image.value().captured_at.value_or(utime);
        if (early && late > *early) periods.push_back(Milliseconds(late - *early));
        early = late;
    }
    recording.Rewind();
    return Quantile(periods, 0.5);
}

LogExportResult Open(const ExportOptions& options, LogRecording& recording) {
    PictureChoice choice;
    if (!options.camera.empty()) choice.channel = CameraChannel(options.camera);
    if (!options.frames.empty()) return ExportFrames(options.frames, choice);
    if (!options.candump.empty()) return ExportCandump(options.candump);
    if (!options.csv.empty()) return ExportCsv(options.csv);
    if (!options.mcap.empty()) return ExportMcap(options.mcap, choice);
    constexpr double kUsual_ms = 1000.0 / 30;
    return ExportMp4(options.mp4, choice, PicturePeriod_ms(recording, choice).value_or(kUsual_ms));
}

int Copy(LogRecording& recording, LogExport& out) {
    LogProgress progress("exporting");
    LogChannels channels;
    auto event = recording.Next();
    for (; event; event = recording.Next()) {
        const auto added = out.Add(event.value(), channels.KindOf(event.value()));
        if (!added) return Fail(kMachineFailed, added.error());
        progress.Show(recording);
    }
    const auto finished = out.Finish();
    if (!finished) return Fail(kMachineFailed, finished.error());
    return event.error() == hal::Error::kEndOfStream ? 0 : Fail(kWrongUse, recording.failure());
}

int Tell(const LogRecording& recording, const LogExport& out) {
    const std::uint64_t skipped = recording.damage().skipped_bytes;
    std::printf("%llu written, %llu damaged ones left out; %llu bytes of the log in no event\n",
                static_cast<unsigned long long>(out.written()),
                static_cast<unsigned long long>(out.damaged()),
                static_cast<unsigned long long>(skipped));
    return out.written() == 0 ? Fail(kBad, "nothing of that kind is in the recording") : 0;
}

}  // namespace

int ExportVerb(const ExportOptions& options, const std::atomic<bool>& stop) {
    const auto files = LogFiles(options.logs);
    if (!files) return Fail(kWrongUse, files.error());
    const std::filesystem::path overwritten = Overwritten(options, files.value());
    if (!overwritten.empty())
        return Fail(kWrongUse, overwritten.string() + ": is the recording itself");
    LogRecording recording(files.value(), stop);
    const auto out = Open(options, recording);
    if (!out) return Fail(kMachineFailed, out.error());
    const int failed = Copy(recording, *out.value());
    return failed != 0 ? failed : Tell(recording, *out.value());
}

}  // namespace hitchview::app
