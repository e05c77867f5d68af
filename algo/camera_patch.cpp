#include "algo/camera_patch.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

/// Sum of kN x kN values `step` apart, from the one at (x, y) on.
template <int kN>
int SumFrom(const SamplePlane& plane, int x, int y, int step) {
    const std::uint8_t* row = plane.row(y) + x * plane.step_bytes;
    const int across = step * plane.step_bytes;
    const std::ptrdiff_t down = static_cast<std::ptrdiff_t>(step) * plane.stride_bytes;
    int sum = 0;
    for (int r = 0; r < kN; ++r, row += down) {
        for (int c = 0; c < kN; ++c) sum += row[c * across];
    }
    return sum;
}

/// The same with the nearest values where the square reaches outside.
template <int kN>
int SumOfNearest(const SamplePlane& plane, int left, int top, int step) {
    int sum = 0;
    for (int r = 0; r < kN; ++r) {
        const std::uint8_t* row = plane.row(std::clamp(top + r * step, 0, plane.rows - 1));
        for (int c = 0; c < kN; ++c)
            sum += row[plane.step_bytes * std::clamp(left + c * step, 0, plane.cols - 1)];
    }
    return sum;
}

/// Mean of kN x kN values round (x, y).
template <int kN>
float MeanOf(const SamplePlane& plane, float x, float y, int step) {
    const int reach = (kN - 1) * step;
    const float half = 0.5F * static_cast<float>(reach);
    const int left = static_cast<int>(x - half + 0.5F);
    const int top = static_cast<int>(y - half + 0.5F);
    const bool inside =
        left >= 0 && top >= 0 && left + reach < plane.cols && top + reach < plane.rows;
    const int sum =
        inside ? SumFrom<kN>(plane, left, top, step) : SumOfNearest<kN>(plane, left, top, step);
    return static_cast<float>(sum) / (kN * kN);
}

/// Asks for the middle of each of `rows` rows round (x, y).
void PrefetchRows(const SamplePlane& plane, int x, int y, int step, int rows) {
    const int top = y - (rows - 1) * step / 2;
    for (int r = 0; r < rows; ++r) {
        const int row = std::clamp(top + r * step, 0, plane.rows - 1);
        __builtin_prefetch(plane.row(row) + x * plane.step_bytes);
    }
}

float MeanChroma(const CameraPatch& patch, int channel, float gain) {
    const CameraFrame& frame = *patch.frame;
    const float x = CameraFrame::ChromaX(patch.x_px);
    const float y = frame.ChromaY(patch.y_px);
    constexpr int kN = CameraPatch::kSamples / 2;
    const float mean = MeanOf<kN>(frame.ChromaSamples(channel), x, y, patch.step_px);
    return 128 + gain * FullChroma(frame.range, mean - 128);
}

}  // namespace

void CameraPatch::Prefetch() const {
    const int x = static_cast<int>(x_px);
    const int y = static_cast<int>(y_px);
    PrefetchRows(frame->LumaSamples(), x, y, step_px, kSamples);
    if (frame->has_chroma() && !frame->is_packed())
        PrefetchRows(frame->ChromaSamples(0), x / 2, y / 2, step_px, kSamples / 2);
}

Eigen::Array4f CameraPatch::Mean(float gain) const {
    const float mean = MeanOf<kSamples>(frame->LumaSamples(), x_px, y_px, step_px);
    const float luma = std::clamp(gain * FullLuma(frame->range, mean), 0.0F, 255.0F);
    if (!frame->has_chroma()) return {luma, 128, 128, 1};
    return {luma, MeanChroma(*this, 0, gain), MeanChroma(*this, 1, gain), 1};
}

}  // namespace hitchview::algo
