#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>

#include "app/log_recording.hpp"

namespace hitchview::app {

/// How much of a recording has been read, on stderr while that is a terminal. The line goes when it
/// is destroyed.
class LogProgress {
 public:
    explicit LogProgress(std::string what) : what_(std::move(what)) {}
    ~LogProgress() {
        if (percent_ >= 0) std::fputs("\r\033[K", stderr);
    }
    LogProgress(const LogProgress&) = delete;
    LogProgress& operator=(const LogProgress&) = delete;

    void Show(const LogRecording& recording) {
        const std::uint64_t all = std::max<std::uint64_t>(recording.size_bytes(), 1);
        const int percent = static_cast<int>(100 * recording.position_bytes() / all);
        if (percent == percent_ || !on_terminal_) return;
        percent_ = percent;
        constexpr std::size_t kWidth = 40;
        std::string bar(static_cast<std::size_t>(percent) * kWidth / 100, '#');
        bar.resize(kWidth, '.');
        std::fprintf(stderr, "\r%s [%s] %3d %%", what_.c_str(), bar.c_str(), percent);
    }

 private:
    std::string what_;
    bool on_terminal_ = isatty(STDERR_FILENO) != 0;
    int percent_ = -1;
};

}  // namespace hitchview::app
