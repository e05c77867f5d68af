#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "algo/camera_frame.hpp"

namespace hitchview::algo {

/// What a camera's values are shown as.
struct CameraLut {
    std::array<std::uint8_t, 256> luma;
    std::array<std::uint8_t, 256> chroma;
};

/// Reads a camera's picture between its pixels, bilinear, in fixed point. Borrows both.
class CameraSampler {
 public:
    CameraSampler() = default;
    CameraSampler(const CameraFrame& frame, const CameraLut& lut) : frame_(&frame), lut_(&lut) {}

    /// True inside the picture: from the centre of its first pixel to that of its last.
    [[nodiscard]] bool Sees(float x, float y) const {
        return x >= 0 && y >= 0 && x <= static_cast<float>(frame_->width_px - 1) &&
               y <= static_cast<float>(frame_->height_px - 1);
    }
    /// Both by luma coordinates; outside the picture the nearest edge's.
    [[nodiscard]] std::array<std::uint8_t, 1> Luma(float x, float y) const {
        const Place px = Split(x, frame_->width_px - 1);
        const Place py = Split(y, frame_->height_px - 1);
        return {lut_->luma[Read<1>(frame_->luma, frame_->luma_stride_bytes, px, py)]};
    }
    /// u and v.
    [[nodiscard]] std::array<std::uint8_t, 2> Chroma(float x, float y) const {
        const Place px = Split(ToChroma(x), frame_->width_px / 2 - 1);
        const Place py = Split(ToChroma(y), frame_->height_px / 2 - 1);
        const int stride_bytes = frame_->chroma_stride_bytes;
        return {lut_->chroma[Read<2>(frame_->chroma, stride_bytes, px, py)],
                lut_->chroma[Read<2>(frame_->chroma + 1, stride_bytes, px, py)]};
    }

 private:
    static constexpr int kFixed = 8;  // bits of a pixel coordinate's fraction
    static constexpr int kOne = 1 << kFixed;

    struct Place {
        int whole;
        int fraction;  // 0..kOne
    };

    /// Splits a coordinate so that whole and whole + 1 lie in 0..last, whatever the coordinate.
    static Place Split(float value, int last) {
        const int fixed = std::clamp(static_cast<int>(value * kOne + 0.5F), 0, last << kFixed);
        const int whole = std::min(fixed >> kFixed, last - 1);
        return {whole, fixed - (whole << kFixed)};
    }
    static float ToChroma(float luma_coordinate) { return 0.5F * luma_coordinate - 0.25F; }

    /// kStep bytes from one sample to the next.
    template <int kStep>
    static std::size_t Read(const std::uint8_t* plane, int stride_bytes, const Place& x,
                            const Place& y) {
        const std::uint8_t* a =
            plane + static_cast<std::ptrdiff_t>(y.whole) * stride_bytes + x.whole * kStep;
        const std::uint8_t* b = a + stride_bytes;
        const int top = a[0] * (kOne - x.fraction) + a[kStep] * x.fraction;
        const int bottom = b[0] * (kOne - x.fraction) + b[kStep] * x.fraction;
        const int sum = top * (kOne - y.fraction) + bottom * y.fraction;
        return static_cast<std::size_t>((sum + (1 << (2 * kFixed - 1))) >> (2 * kFixed));
    }

    const CameraFrame* frame_ = nullptr;
    const CameraLut* lut_ = nullptr;
};

}  // namespace hitchview::algo
