#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "drivers/frame_colour.hpp"
#include "drivers/replay_image_list.hpp"
#include "drivers/replay_jpeg_decoder.hpp"
#include "drivers/replay_source.hpp"

namespace hitchview::drivers {
namespace {

cv::Mat ReadBgr(const std::string& path) {
    try {
        return cv::imread(path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) {
        return {};
    }
}

class ImageSource final : public ReplaySource {
 public:
    ImageSource(std::vector<std::string> paths, cv::Size size)
        : ReplaySource(size.width, size.height, 0),
          paths_(std::move(paths)),
          size_(size),
          jpeg_(size.width, size.height) {}

 private:
    hal::Result<hal::Done> DoRead(std::span<std::uint8_t> nv12) override {
        if (next_ == paths_.size()) return hal::Error::kEndOfStream;
        const std::string& path = paths_[next_++];
        const JpegDecoder::Outcome outcome = jpeg_.DecodeFile(path);
        if (outcome == JpegDecoder::Outcome::kDamaged) return hal::Error::kCorrupted;
        if (outcome == JpegDecoder::Outcome::kNotForUs) return TakeOther(path, nv12);
        ToNv12(jpeg_.picture(), format(), nv12);
        return hal::Done{};
    }

    hal::Result<hal::Done> TakeOther(const std::string& path, std::span<std::uint8_t> nv12) {
        const cv::Mat bgr = ReadBgr(path);
        if (bgr.size() != size_) return hal::Error::kCorrupted;
        ToNv12(BgrPicture{bgr.data, static_cast<std::ptrdiff_t>(bgr.step)}, format(), nv12);
        return hal::Done{};
    }

    std::vector<std::string> paths_;
    std::size_t next_ = 0;
    cv::Size size_;
    JpegDecoder jpeg_;
};

}  // namespace

hal::Checked<std::unique_ptr<ReplaySource>> OpenImageSource(const std::string& path) {
    auto paths = path.find('%') != std::string::npos ? ListPattern(path) : ListFolder(path);
    if (!paths) return paths.error();
    const cv::Size size = ReadBgr(paths->front()).size();
    if (size.empty()) return paths->front() + ": not a picture, or of a format we cannot read";
    if (size.width < 2 || size.height < 2) return paths->front() + ": smaller than 2 x 2 px";
    return std::unique_ptr<ReplaySource>(std::make_unique<ImageSource>(std::move(*paths), size));
}

}  // namespace hitchview::drivers
