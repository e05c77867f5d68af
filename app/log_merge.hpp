#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/log_recording.hpp"

namespace hitchview::app {

/// The events of several recordings in order of time, as far as each of them is in it. Thread: one.
class LogMerge {
 public:
    struct Event {
        std::size_t recording = 0;
        std::size_t file = 0;  ///< of the recording
        drivers::LcmLogEvent event;
    };

    /// See LogRecording.
    LogMerge(const std::vector<std::vector<std::filesystem::path>>& recordings,
             const std::atomic<bool>& stop);

    /// The next event will be the first of each recording with this time or a later one.
    void SeekToTime(std::int64_t utime_us);
    /// Borrowed until the next call. kEndOfStream: no further event. kFailed: failure() says why.
    hal::Result<Event> Next();
    [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
    struct Source {
        std::unique_ptr<LogRecording> recording;
        hal::Result<drivers::LcmLogEvent> head = hal::Error::kTimeout;  ///< kTimeout: not read yet
    };

    std::vector<Source> sources_;
    std::string failure_;
};

}  // namespace hitchview::app
