#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "algo/camera_frame.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::tests {

/// A camera picture in any layout and range, that owns its pixels; rows are longer than the
/// picture needs. Made from full-range planes: luma, and colour at half the width and height.
class CameraPicture {
 public:
    struct Content {
        cv::Mat1b luma;
        cv::Mat1b u;
        cv::Mat1b v;
    };

    CameraPicture(const Content& content, algo::PixelLayout layout, algo::SampleRange range,
                  int padding_bytes = 24)
        : size_(content.luma.size()), layout_(layout), range_(range) {
        frame_ = {
            .width_px = size_.width, .height_px = size_.height, .layout = layout, .range = range};
        stride_bytes_ = size_.width * (frame_.is_packed() ? 2 : 1) + padding_bytes;
        const bool planar_chroma = layout == algo::PixelLayout::kNv12;
        bytes_.assign(
            static_cast<std::size_t>(stride_bytes_) *
                static_cast<std::size_t>(size_.height + (planar_chroma ? size_.height / 2 : 0)),
            0);
        const algo::CameraFrame at = frame();
        Write(at.LumaSamples(), content.luma, 16, 219, 0);
        if (!at.has_chroma()) return;
        Write(at.ChromaSamples(0), content.u, 128, 224, 128);
        Write(at.ChromaSamples(1), content.v, 128, 224, 128);
    }

    /// Blurred noise in grey and colour.
    static Content RandomContent(cv::Size size, std::uint64_t seed) {
        return {Texture(size, seed), Texture(size / 2, seed + 100), Texture(size / 2, seed + 200)};
    }
    static CameraPicture Textured(cv::Size size, algo::PixelLayout layout, algo::SampleRange range,
                                  std::uint64_t seed) {
        return {RandomContent(size, seed), layout, range, 0};
    }

    [[nodiscard]] algo::CameraFrame frame() const {
        algo::CameraFrame frame = frame_;
        frame.luma = frame.chroma = bytes_.data();
        frame.luma_stride_bytes = frame.chroma_stride_bytes = stride_bytes_;
        if (layout_ == algo::PixelLayout::kNv12)
            frame.chroma += static_cast<std::ptrdiff_t>(stride_bytes_) * size_.height;
        return frame;
    }
    [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }

 private:
    /// `values` to the bytes of a plane; a packed layout shows each row of colour twice.
    void Write(const algo::SamplePlane& plane, const cv::Mat1b& values, int zero, int span,
               int centre) {
        const bool limited = range_ == algo::SampleRange::kLimited;
        for (int y = 0; y < plane.rows; ++y) {
            std::uint8_t* to = bytes_.data() + (plane.row(y) - bytes_.data());
            const std::uint8_t* from = values[y * values.rows / plane.rows];
            for (int x = 0; x < plane.cols; ++x) {
                const double scaled = zero + (from[x] - centre) * span / 255.0;
                to[x * plane.step_bytes] =
                    limited ? static_cast<std::uint8_t>(std::lround(scaled)) : from[x];
            }
        }
    }

    cv::Size size_;
    algo::PixelLayout layout_;
    algo::SampleRange range_;
    algo::CameraFrame frame_;
    int stride_bytes_ = 0;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace hitchview::tests
