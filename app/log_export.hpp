#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "app/log_channels.hpp"
#include "drivers/lcm_log_reader.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Turns the events of a recording into a file, or files, of another kind. Thread: one.
class LogExport {
 public:
    virtual ~LogExport() = default;

    /// One event after another. What is damaged is counted and left out. The error names the file
    /// and says why.
    virtual hal::Checked<hal::Done> Add(const drivers::LcmLogEvent& event,
                                        drivers::LoggedKind kind) = 0;
    /// Once, after the last event.
    virtual hal::Checked<hal::Done> Finish() = 0;

    [[nodiscard]] std::uint64_t written() const { return written_; }  ///< pictures, lines, messages
    [[nodiscard]] std::uint64_t damaged() const { return damaged_; }

 protected:
    void CountWritten(std::uint64_t count = 1) { written_ += count; }
    void CountDamaged() { ++damaged_; }

 private:
    std::uint64_t written_ = 0;
    std::uint64_t damaged_ = 0;
};

/// Which pictures of a recording are meant.
struct PictureChoice {
    std::string channel;  ///< of a camera; empty: the panorama's

    [[nodiscard]] bool Means(const drivers::LcmLogEvent& event, drivers::LoggedKind kind) const {
        if (kind != drivers::LoggedKind::kImage) return false;
        return channel.empty() ? !IsCameraChannel(event.channel) : event.channel == channel;
    }
};

using LogExportResult = hal::Checked<std::unique_ptr<LogExport>>;

/// Every CAN frame as a line of `candump -L`.
LogExportResult ExportCandump(const std::filesystem::path& file);

/// Every panorama's status as a line, with the vehicle's newest hitch angle beside it.
LogExportResult ExportCsv(const std::filesystem::path& file);

/// PNG files `<number>_<utime>.png` in a folder.
LogExportResult ExportFrames(const std::filesystem::path& folder, const PictureChoice& choice);

/// H.264 in MP4, made by the program ffmpeg, at a constant rate: what is missing is shown as a
/// still picture, two seconds of it at most. `period_ms` > 0: from one picture to the next.
LogExportResult ExportMp4(const std::filesystem::path& file, const PictureChoice& choice,
                          double period_ms);

/// Everything as MCAP: pictures as foxglove.CompressedImage, events as foxglove.Log, the rest as
/// JSON. `choice` with a channel: of the pictures only its.
LogExportResult ExportMcap(const std::filesystem::path& file, const PictureChoice& choice);

}  // namespace hitchview::app
