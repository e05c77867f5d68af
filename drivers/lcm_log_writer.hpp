#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// Writes an LCM log file that every tool of LCM reads. The file holds whole events only: what a
/// full disk let through of an event is cut off again, and a power cut tears at most the last one.
/// Thread: one. Takes no memory after Create.
class LcmLogWriter {
 public:
    /// Replaces the file. The error names it and says why.
    static hal::Checked<std::unique_ptr<LcmLogWriter>> Create(const std::filesystem::path& file);
    ~LcmLogWriter();
    LcmLogWriter(const LcmLogWriter&) = delete;
    LcmLogWriter& operator=(const LcmLogWriter&) = delete;

    /// One event behind the others; its number counts up from 0. `channel`: 1 to 63 characters.
    /// kTooLarge: the data is longer than the format can say (2^31 - 1 bytes). kFailed: the system
    /// refused, errno says why (ENOSPC: the disk is full); the file is as before the call, and the
    /// next call may succeed.
    hal::Result<hal::Done> Append(std::int64_t utime_us, std::string_view channel,
                                  std::span<const std::uint8_t> data);

    /// Waits until everything is on the disk. kFailed: errno says why.
    hal::Result<hal::Done> Sync();

    /// In the file, in whole events.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    [[nodiscard]] std::int64_t events() const { return events_; }

 private:
    explicit LcmLogWriter(int descriptor) : descriptor_(descriptor) {}

    int descriptor_;
    std::uint64_t bytes_ = 0;
    std::int64_t events_ = 0;
};

}  // namespace hitchview::drivers
