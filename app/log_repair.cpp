#include "app/log_repair.hpp"

#include <cerrno>
#include <cstring>

#include "app/log_progress.hpp"
#include "drivers/lcm_log_writer.hpp"

namespace hitchview::app {
namespace {

using hal::Checked;

/// Empty, or why it ended early.
std::string CopyEvents(LogRecording& recording, drivers::LcmLogWriter& writer,
                       const std::filesystem::path& out) {
    LogProgress progress("writing " + out.filename().string());
    recording.Rewind();
    auto event = recording.Next();
    for (; event; event = recording.Next()) {
        const auto& [number, utime_us, channel, data, position] = event.value();
        if (!writer.Append(utime_us, channel, data))
            return out.string() + ": cannot be written: " + std::strerror(errno);
        progress.Show(recording);
    }
    if (event.error() != hal::Error::kEndOfStream) return recording.failure();
    if (!writer.Sync()) return out.string() + ": cannot be written: " + std::strerror(errno);
    return "";
}

}  // namespace

Checked<LogRepair> RepairLog(LogRecording& recording, const std::filesystem::path& out) {
    std::error_code failed;
    if (std::filesystem::exists(out, failed)) return out.string() + ": exists already";
    auto writer = drivers::LcmLogWriter::Create(out);
    if (!writer) return writer.error();
    const std::string refused = CopyEvents(recording, **writer, out);
    if (refused.empty())
        return LogRepair{static_cast<std::uint64_t>((*writer)->events()), (*writer)->bytes()};
    std::filesystem::remove(out, failed);
    return refused;
}

}  // namespace hitchview::app
