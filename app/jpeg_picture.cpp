#include "app/jpeg_picture.hpp"

#include <turbojpeg.h>

#include <memory>

namespace hitchview::app {
namespace {

struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
};

}  // namespace

bool DecodeJpeg(std::span<const std::uint8_t> jpeg, cv::Size size_px, cv::Mat& bgr) {
    const std::unique_ptr<void, Destroy> decoder(tjInitDecompress());
    cv::Size stated_px;
    int subsampling = 0;
    int colour_space = 0;
    const int header =
        tjDecompressHeader3(decoder.get(), jpeg.data(), jpeg.size(), &stated_px.width,
                            &stated_px.height, &subsampling, &colour_space);
    if (header != 0 || stated_px != size_px) return false;

    cv::Mat decoded(size_px, CV_8UC3);
    const int flags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
    if (tjDecompress2(decoder.get(), jpeg.data(), jpeg.size(), decoded.data, decoded.cols,
                      static_cast<int>(decoded.step), decoded.rows, TJPF_BGR, flags) != 0) {
        return false;
    }
    bgr = decoded;
    return true;
}

}  // namespace hitchview::app
