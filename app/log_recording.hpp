#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "drivers/lcm_log_reader.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Files of one recording, in their order: a file stands for itself, a folder for the *.lcm in it
/// by name, which is by time for those that `record` writes. The error names what cannot be read or
/// has none.
hal::Checked<std::vector<std::filesystem::path>> LogFiles(
    const std::vector<std::filesystem::path>& logs);

/// The events of a recording, one segment after another. Memory: that of one segment's reader.
/// Thread: one.
class LogRecording {
 public:
    /// `files` from LogFiles. `stop`: set from outside, reading then fails; outlives this.
    LogRecording(std::vector<std::filesystem::path> files, const std::atomic<bool>& stop);

    /// Borrowed until the next call. kEndOfStream: no further event. kFailed: failure() says why.
    hal::Result<drivers::LcmLogEvent> Next();
    /// The next event is the first again, and nothing is damaged yet.
    void Rewind();
    /// Rewinds, and the next event will be the first with a time of `utime_us` or later. A
    /// recording whose events are all earlier has no further event.
    void SeekToTime(std::int64_t utime_us);

    [[nodiscard]] const std::string& failure() const { return failure_; }
    /// Of all segments so far.
    [[nodiscard]] drivers::LcmLogDamage damage() const;
    [[nodiscard]] std::size_t segments() const { return files_.size(); }
    /// Of the newest event.
    [[nodiscard]] std::size_t file() const { return next_file_ - 1; }
    [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
    /// Of size_bytes().
    [[nodiscard]] std::uint64_t position_bytes() const;

 private:
    bool OpenNext();
    void CloseSegment();

    std::vector<std::filesystem::path> files_;
    const std::atomic<bool>& stop_;
    std::uint64_t size_bytes_ = 0;
    std::size_t next_file_ = 0;
    std::unique_ptr<drivers::LcmLogReader> reader_;
    std::uint64_t closed_bytes_ = 0;
    drivers::LcmLogDamage closed_damage_;  ///< of the segments before the open one
    std::string failure_;
};

}  // namespace hitchview::app
