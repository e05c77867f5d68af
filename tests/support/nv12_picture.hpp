#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "algo/camera_frame.hpp"
#include "algo/panorama_planes.hpp"

namespace hitchview::tests {

/// A camera picture that owns its pixels; rows are longer than the picture is wide.
class Nv12Picture {
 public:
    explicit Nv12Picture(const cv::Mat1b& luma, std::uint8_t u = 128, std::uint8_t v = 128)
        : size_(luma.size()),
          luma_(size_.height, size_.width + kPadding, std::uint8_t{0}),
          chroma_(size_.height / 2, size_.width + kPadding, std::uint8_t{0}) {
        luma.copyTo(luma_(cv::Rect({0, 0}, size_)));
        for (int y = 0; y < chroma_.rows; ++y) {
            for (int x = 0; x < size_.width; ++x) chroma_(y, x) = x % 2 == 0 ? u : v;
        }
    }

    [[nodiscard]] algo::CameraFrame frame() const {
        return {.width_px = size_.width,
                .height_px = size_.height,
                .luma = luma_.data,
                .luma_stride_bytes = static_cast<int>(luma_.step1()),
                .chroma = chroma_.data,
                .chroma_stride_bytes = static_cast<int>(chroma_.step1())};
    }
    cv::Mat1b& chroma() { return chroma_; }

 private:
    static constexpr int kPadding = 24;
    cv::Size size_;
    cv::Mat1b luma_;
    cv::Mat1b chroma_;
};

/// A panorama that owns its pixels, filled with a value that no test expects.
class PanoramaPicture {
 public:
    explicit PanoramaPicture(cv::Size size)
        : y_(size, kStale), u_(size / 2, kStale), v_(size / 2, kStale) {}

    static constexpr std::uint8_t kStale = 201;
    algo::PanoramaPlanes planes() {
        return {.width_px = y_.cols,
                .height_px = y_.rows,
                .y = y_.data,
                .y_stride_bytes = static_cast<int>(y_.step1()),
                .u = u_.data,
                .v = v_.data,
                .chroma_stride_bytes = static_cast<int>(u_.step1())};
    }
    [[nodiscard]] const cv::Mat1b& y() const { return y_; }
    [[nodiscard]] const cv::Mat1b& u() const { return u_; }
    [[nodiscard]] const cv::Mat1b& v() const { return v_; }

    friend bool operator==(const PanoramaPicture& a, const PanoramaPicture& b) {
        return cv::norm(a.y_, b.y_, cv::NORM_INF) == 0 && cv::norm(a.u_, b.u_, cv::NORM_INF) == 0 &&
               cv::norm(a.v_, b.v_, cv::NORM_INF) == 0;
    }

 private:
    cv::Mat1b y_;
    cv::Mat1b u_;
    cv::Mat1b v_;
};

}  // namespace hitchview::tests
