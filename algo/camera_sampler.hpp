#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "algo/camera_frame.hpp"

namespace hitchview::algo {

/// One camera's picture and how its values are shown: luma times its gain, colour's distance from
/// grey too, both in full range. Borrows the pixels.
class CameraSampler {
 public:
    /// What the vector kernels multiply with; fixed point.
    struct Tone {
        bool as_taken;               ///< nothing changes; the rest is not read
        std::uint16_t luma_black;    ///< of a byte, 7 fractional bits
        std::uint16_t luma_factor;   ///< 13 fractional bits
        std::int16_t chroma_factor;  ///< 12 fractional bits
    };

    CameraSampler() = default;
    /// `gain`: (0.25, 4).
    CameraSampler(const CameraFrame& frame, float gain)
        : frame_(frame), gain_(gain), tone_(ToneOf(frame.range, gain)) {
        planes_[0] = frame.LumaSamples();
        if (!frame.has_chroma()) return;
        planes_[1] = frame.ChromaSamples(0);
        planes_[2] = frame.ChromaSamples(1);
    }

    [[nodiscard]] const CameraFrame& frame() const { return frame_; }
    [[nodiscard]] const Tone& tone() const { return tone_; }

    /// True inside the picture, `margin_px` or more from the centres of its outermost pixels.
    [[nodiscard]] bool Sees(float x, float y, float margin_px = 0) const {
        return x >= margin_px && y >= margin_px &&
               x <= static_cast<float>(frame_.width_px - 1) - margin_px &&
               y <= static_cast<float>(frame_.height_px - 1) - margin_px;
    }
    /// Read between the pixels, bilinear, by luma coordinates; outside the picture the nearest
    /// edge's. Grey levels.
    [[nodiscard]] std::array<float, 1> Luma(float x, float y) const {
        return {Shown(gain_ * FullLuma(frame_.range, Read(planes_[0], x, y)))};
    }
    /// u and v.
    [[nodiscard]] std::array<float, 2> Chroma(float x, float y) const {
        if (!frame_.has_chroma()) return {128, 128};
        const float cx = CameraFrame::ChromaX(x);
        const float cy = frame_.ChromaY(y);
        const auto shown = [&](const SamplePlane& plane) {
            const float value = Read(plane, cx, cy) - 128;
            return Shown(128 + gain_ * FullChroma(frame_.range, value));
        };
        return {shown(planes_[1]), shown(planes_[2])};
    }

 private:
    static float Shown(float value) { return std::clamp(value, 0.0F, 255.0F); }

    static Tone ToneOf(SampleRange range, float gain) {
        const float luma = gain * (FullLuma(range, 1) - FullLuma(range, 0));
        const float chroma = gain * FullChroma(range, 1);
        const bool limited = range == SampleRange::kLimited;
        return {.as_taken = !limited && std::abs(gain - 1) < 1e-4F,
                .luma_black = static_cast<std::uint16_t>(limited ? 16 << 7 : 0),
                .luma_factor = static_cast<std::uint16_t>(std::lround(luma * (1 << 13))),
                .chroma_factor = static_cast<std::int16_t>(std::lround(chroma * (1 << 12)))};
    }

    static float Read(const SamplePlane& plane, float x, float y) {
        x = std::clamp(x, 0.0F, static_cast<float>(plane.cols - 1));
        y = std::clamp(y, 0.0F, static_cast<float>(plane.rows - 1));
        const auto left = static_cast<int>(x);
        const auto top = static_cast<int>(y);
        const int right = std::min(left + 1, plane.cols - 1) * plane.step_bytes;
        const float fx = x - static_cast<float>(left);
        const float fy = y - static_cast<float>(top);
        const std::uint8_t* a = plane.row(top);
        const std::uint8_t* b = plane.row(std::min(top + 1, plane.rows - 1));
        const auto between = [&](const std::uint8_t* row) {
            const int from = row[left * plane.step_bytes];
            return static_cast<float>(from) + fx * static_cast<float>(row[right] - from);
        };
        const float upper = between(a);
        return upper + fy * (between(b) - upper);
    }

    CameraFrame frame_;
    float gain_ = 1;
    Tone tone_{};
    std::array<SamplePlane, 3> planes_;
};

}  // namespace hitchview::algo
