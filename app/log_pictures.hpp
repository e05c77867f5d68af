#pragma once

#include <atomic>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "app/log_recording.hpp"

namespace hitchview::app {

/// The pictures of one camera in a recording, in order. Damaged ones are passed over. Thread: one.
class LogPictures {
 public:
    /// `camera`: its name; or the name of a channel.
    LogPictures(std::vector<std::filesystem::path> files, std::string camera);

    /// 8-bit BGR; nothing at the end, or where the recording cannot be read on.
    std::optional<cv::Mat> Next();
    /// Why it ended before its end; empty if it did not.
    [[nodiscard]] const std::string& failure() const { return recording_.failure(); }

 private:
    std::atomic<bool> stop_{false};
    LogRecording recording_;
    std::string camera_;
};

}  // namespace hitchview::app
