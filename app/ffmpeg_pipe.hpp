#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "hal/result.hpp"

namespace hitchview::app {

struct FfmpegOptions {
    cv::Size size_px;
    double rate_hz = 30;
    std::string program = "ffmpeg";  ///< looked for in PATH
};

/// An H.264 video in MP4, made by the program ffmpeg from pictures that it is sent. Thread: one.
class FfmpegPipe {
 public:
    /// Replaces the file. The error says what to do where the program is not installed.
    static hal::Checked<std::unique_ptr<FfmpegPipe>> Start(const std::filesystem::path& file,
                                                           const FfmpegOptions& options);
    ~FfmpegPipe();
    FfmpegPipe(const FfmpegPipe&) = delete;
    FfmpegPipe& operator=(const FfmpegPipe&) = delete;

    /// 8-bit BGR of the size that was said, without gaps between its rows. kFailed: the program has
    /// ended.
    hal::Result<hal::Done> Append(const cv::Mat& picture);
    /// Waits for the program. Once. The error: it failed; it has said why on stderr.
    hal::Checked<hal::Done> Finish();

 private:
    FfmpegPipe(std::filesystem::path file, int process, int socket)
        : file_(std::move(file)), process_(process), socket_(socket) {}

    std::filesystem::path file_;
    int process_;
    int socket_;  ///< -1: closed
};

}  // namespace hitchview::app
