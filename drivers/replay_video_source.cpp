#include <algorithm>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>
#include <system_error>
#include <utility>

#include "drivers/frame_colour.hpp"
#include "drivers/replay_source.hpp"

namespace hitchview::drivers {
namespace {

class VideoSource final : public ReplaySource {
 public:
    /// `first`: the frame already read from `capture`.
    VideoSource(cv::VideoCapture capture, cv::Mat first)
        : ReplaySource(first.cols, first.rows, capture.get(cv::CAP_PROP_FPS)),
          capture_(std::move(capture)),
          size_(first.size()),
          bgr_(std::move(first)) {}

 private:
    hal::Result<hal::Done> DoRead(std::span<std::uint8_t> nv12) override {
        if (!std::exchange(first_is_pending_, false) && !ReadNext()) {
            return hal::Error::kEndOfStream;
        }
        if (bgr_.size() != size_ || bgr_.type() != CV_8UC3) return hal::Error::kCorrupted;
        ToNv12(BgrPicture{bgr_.data, static_cast<std::ptrdiff_t>(bgr_.step)}, format(), nv12);
        return hal::Done{};
    }

    bool ReadNext() {
        try {
            return capture_.read(bgr_);
        } catch (const cv::Exception&) {
            return false;
        }
    }

    cv::VideoCapture capture_;
    cv::Size size_;
    cv::Mat bgr_;
    bool first_is_pending_ = true;
};

// FFmpeg where OpenCV has it: other back ends follow container timestamps and repeat frames.
int PreferredBackend() {
    const auto backends = cv::videoio_registry::getStreamBackends();
    const bool ffmpeg = std::ranges::find(backends, cv::CAP_FFMPEG) != backends.end();
    return ffmpeg ? cv::CAP_FFMPEG : cv::CAP_ANY;
}

}  // namespace

hal::Checked<std::unique_ptr<ReplaySource>> OpenVideoSource(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return path + ": no such file";
    try {
        cv::VideoCapture capture(path, PreferredBackend());
        cv::Mat first;
        if (!capture.isOpened()) return path + ": not a video, or of a format we cannot read";
        if (!capture.read(first) || first.type() != CV_8UC3) {
            return path + ": no frame could be decoded; is its codec installed?";
        }
        if (first.cols < 2 || first.rows < 2) return path + ": smaller than 2 x 2 px";
        return std::unique_ptr<ReplaySource>(
            std::make_unique<VideoSource>(std::move(capture), std::move(first)));
    } catch (const cv::Exception& exception) {
        return path + ": " + exception.what();
    }
}

}  // namespace hitchview::drivers
