#include "app/log_picture.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "lcmtypes/bot_core_image_t.h"

namespace hitchview::app {
namespace {

using drivers::LoggedImage;

// OpenCV's types have no const; decoding only reads.
cv::Mat Bytes(const LoggedImage& image, int rows, int columns, int channels) {
    const auto stride = static_cast<std::size_t>(image.row_stride_bytes > 0 ? image.row_stride_bytes
                                                                            : columns * channels);
    const auto row_bytes = static_cast<std::size_t>(columns) * static_cast<std::size_t>(channels);
    const std::size_t needed = stride * (static_cast<std::size_t>(rows) - 1) + row_bytes;
    if (stride < row_bytes || image.data.size() < needed) return {};
    auto* const data = const_cast<std::uint8_t*>(image.data.data());
    return {rows, columns, CV_8UC(channels), data, stride};
}

/// What televisions leave unused above and below is spread over the whole range, so that OpenCV's
/// conversion for full range fits all.
void SpreadRange(double unused, double used, cv::Mat& plane) {
    plane.convertTo(plane, CV_8U, 255 / used, -unused * 255 / used);
}

cv::Mat FromPlanes(cv::Mat luma, cv::Mat u, cv::Mat v, hal::Range range) {
    if (range == hal::Range::kLimited) {
        SpreadRange(16, 219, luma);
        for (cv::Mat* const chroma : {&u, &v})
            chroma->convertTo(*chroma, CV_8U, 255.0 / 224, 128 - 128 * 255.0 / 224);
    }
    cv::resize(u, u, luma.size(), 0, 0, cv::INTER_LINEAR);
    cv::resize(v, v, luma.size(), 0, 0, cv::INTER_LINEAR);
    cv::Mat joined;
    cv::Mat picture;
    cv::merge(std::vector<cv::Mat>{luma, v, u}, joined);
    cv::cvtColor(joined, picture, cv::COLOR_YCrCb2BGR);
    return picture;
}

/// Two pixels in four bytes, luma at `luma_at` of each pair.
cv::Mat FromPairs(const LoggedImage& image, int luma_at) {
    const cv::Mat pairs = Bytes(image, image.height_px, image.width_px, 2);
    if (pairs.empty() || image.width_px % 2 != 0) return {};
    std::vector<cv::Mat> halves;
    cv::split(pairs, halves);
    const cv::Mat chroma = halves[static_cast<std::size_t>(1 - luma_at)].reshape(2);
    std::vector<cv::Mat> uv;
    cv::split(chroma, uv);
    return FromPlanes(halves[static_cast<std::size_t>(luma_at)], uv[0], uv[1], image.range);
}

cv::Mat FromNv12(const LoggedImage& image) {
    if (image.width_px % 2 != 0 || image.height_px % 2 != 0) return {};
    const cv::Mat all = Bytes(image, image.height_px * 3 / 2, image.width_px, 1);
    if (all.empty()) return {};
    std::vector<cv::Mat> uv;
    cv::split(all.rowRange(image.height_px, all.rows).clone().reshape(2), uv);
    return FromPlanes(all.rowRange(0, image.height_px).clone(), uv[0], uv[1], image.range);
}

cv::Mat FromGrey(const LoggedImage& image) {
    cv::Mat grey = Bytes(image, image.height_px, image.width_px, 1).clone();
    if (grey.empty()) return {};
    if (image.range == hal::Range::kLimited) SpreadRange(16, 219, grey);
    cv::Mat picture;
    cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
    return picture;
}

/// A file may claim any size; the message's is bounded.
cv::Mat FromJpeg(const LoggedImage& image) {
    auto* const data = const_cast<std::uint8_t*>(image.data.data());
    const cv::Mat file(1, static_cast<int>(image.data.size()), CV_8U, data);
    try {
        cv::Mat picture = cv::imdecode(file, cv::IMREAD_COLOR);
        return picture.size() == cv::Size(image.width_px, image.height_px) ? picture : cv::Mat();
    } catch (const cv::Exception&) {
        return {};
    }
}

}  // namespace

cv::Mat PictureOf(const LoggedImage& image) {
    switch (image.fourcc) {
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG:
            return FromJpeg(image);
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY:
            return FromPairs(image, 1);
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_YUYV:
            return FromPairs(image, 0);
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12:
            return FromNv12(image);
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY:
            return FromGrey(image);
        default:
            return {};
    }
}

}  // namespace hitchview::app
