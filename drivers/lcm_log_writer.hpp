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
/// Thread: one. Takes no memory, but for Create.
class LcmLogWriter {
 public:
    /// Without a file until Open.
    LcmLogWriter() = default;
    /// Replaces the file. The error names it and says why.
    static hal::Checked<std::unique_ptr<LcmLogWriter>> Create(const std::filesystem::path& file);
    ~LcmLogWriter();
    LcmLogWriter(const LcmLogWriter&) = delete;
    LcmLogWriter& operator=(const LcmLogWriter&) = delete;

    /// Begins another file, after the one before was closed; replaces it if it exists. kFailed:
    /// errno says why; there is no file then.
    hal::Result<hal::Done> Open(const char* file);
    /// Without waiting for the disk. Nothing to do without a file.
    void Close();
    [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }

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
    int descriptor_ = -1;
    std::uint64_t bytes_ = 0;
    std::int64_t events_ = 0;
};

}  // namespace hitchview::drivers
