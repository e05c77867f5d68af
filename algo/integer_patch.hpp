#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace hitchview::algo {

/// Patches of a grey picture in 16-bit integers, and the sums over them that alignment needs. No
/// rounding depends on the processor. A row is a whole vector: it reaches one pixel farther to the
/// right of the centre than to the left.
struct IntegerPatch {
    static constexpr int kWidth = 16;   ///< px
    static constexpr int kHeight = 15;  ///< px
    static constexpr int kLeft = 7;     ///< px left of the centre, and above and below it
    static constexpr int kRight = 8;    ///< px right of the centre
    static constexpr int kArea = kWidth * kHeight;
    static constexpr int kUnit = 64;      ///< sampled positions are multiples of 1 / kUnit px
    static constexpr int kGreyUnit = 16;  ///< sampled grey levels are multiples of 1 / kGreyUnit

    using Values = std::array<std::int16_t, kArea>;
    alignas(32) Values value;
};

/// A patch that is looked for: grey as sampled, and kSlopeUnit times its slopes, from central
/// differences.
struct TemplatePatch {
    static constexpr int kSlopeUnit = 8;
    IntegerPatch grey;
    IntegerPatch slope_x;
    IntegerPatch slope_y;
};

/// Sums over a template alone. Each is below 2^31.
struct TemplateSums {
    std::int32_t g, x, y;  ///< grey, slopes
    std::int32_t gg, xx, xy, yy, gx, gy;
};

/// Sums over a sampled patch p and its products with a template. Each is below 2^31.
struct SampleSums {
    std::int32_t p, pp, xp, yp;
};

/// Bilinear samples around (centre_x, centre_y) / kUnit px, kGreyUnit (grey level - 128). The
/// patch, and one pixel more to the right and below, must lie inside.
void SamplePatch(const cv::Mat1b& image, int centre_x, int centre_y, IntegerPatch& p);
/// The same with its slopes; one pixel more is needed on each side.
void SampleTemplate(const cv::Mat1b& image, int centre_x, int centre_y, TemplatePatch& t);
TemplateSums SumTemplate(const TemplatePatch& t);
SampleSums SumSample(const TemplatePatch& t, const IntegerPatch& p);
/// Sum of the products of a template's grey levels and a sampled patch.
std::int32_t SumProducts(const IntegerPatch& template_grey, const IntegerPatch& p);

}  // namespace hitchview::algo
