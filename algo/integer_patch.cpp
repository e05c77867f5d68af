#include "algo/integer_patch.hpp"

#include <cstring>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

constexpr int kWidth = IntegerPatch::kWidth;
constexpr int kHeight = IntegerPatch::kHeight;
constexpr int kArea = IntegerPatch::kArea;
constexpr int kLeft = IntegerPatch::kLeft;
constexpr int kUnit = IntegerPatch::kUnit;
constexpr int kGreyUnit = IntegerPatch::kGreyUnit;
/// Of samples blended along a row: whatever two of them blend to fits into 16 bits.
constexpr int kRowGreyUnit = 8;
static_assert(255 * kRowGreyUnit * kUnit + kUnit < 1 << 16);
constexpr int kMiddleGrey = 128;

struct Fraction {
    std::uint16_t x;
    std::uint16_t y;
};

/// Pixels of `rows` rows of a patch, one after the other: loops over them need no end of a row.
template <int kRows>
struct Pixels {
    alignas(32) std::array<std::uint8_t, kRows * kWidth> grey;

    Pixels(const std::uint8_t* top_left, std::ptrdiff_t step) {
        for (int y = 0; y < kRows; ++y) {
            std::memcpy(grey.data() + y * kWidth, top_left + y * step, kWidth);
        }
    }
};

/// `pixels`: from one row above the patch to one below.
HV_MULTIVERSION
void CutRows(const std::uint8_t* __restrict pixels, const std::uint8_t* __restrict left,
             const std::uint8_t* __restrict right, TemplatePatch& t) {
    std::int16_t* __restrict grey = t.grey.value.data();
    std::int16_t* __restrict slope_x = t.slope_x.value.data();
    std::int16_t* __restrict slope_y = t.slope_y.value.data();
    const std::uint8_t* __restrict above = pixels;
    const std::uint8_t* __restrict here = pixels + kWidth;
    const std::uint8_t* __restrict below = pixels + 2 * kWidth;
    for (int i = 0; i < kArea; ++i) {
        grey[i] = static_cast<std::int16_t>(here[i] - kMiddleGrey);
        slope_x[i] = static_cast<std::int16_t>(right[i] - left[i]);
        slope_y[i] = static_cast<std::int16_t>(below[i] - above[i]);
    }
}

/// Blends along rows, `right` being one pixel beside `pixels`, then along columns.
HV_MULTIVERSION
void SampleRows(const std::uint8_t* __restrict pixels, const std::uint8_t* __restrict right,
                Fraction f, std::int16_t* __restrict out) {
    constexpr int kRowScale = kUnit / kRowGreyUnit;
    constexpr int kRowHalf = kRowScale / 2;
    constexpr int kScale = kUnit * kRowGreyUnit / kGreyUnit;
    constexpr int kHalfScale = kScale / 2;
    alignas(32) std::uint16_t blended[kArea + kWidth];
    const auto gx = static_cast<std::uint16_t>(kUnit - f.x);
    const auto gy = static_cast<std::uint16_t>(kUnit - f.y);
    for (int i = 0; i < kArea + kWidth; ++i) {
        const auto sum = static_cast<std::uint16_t>(pixels[i] * gx + right[i] * f.x + kRowHalf);
        blended[i] = static_cast<std::uint16_t>(sum / kRowScale);
    }
    for (int i = 0; i < kArea; ++i) {
        const auto sum =
            static_cast<std::uint16_t>(blended[i] * gy + blended[i + kWidth] * f.y + kHalfScale);
        const auto grey = static_cast<std::int16_t>(sum / kScale);
        out[i] = static_cast<std::int16_t>(grey - kGreyUnit * kMiddleGrey);
    }
}

HV_MULTIVERSION
SampleSums SumRows(const std::int16_t* __restrict slope_x, const std::int16_t* __restrict slope_y,
                   const std::int16_t* __restrict p) {
    SampleSums s{};
    for (int i = 0; i < kArea; ++i) {
        s.p += p[i];
        s.pp += p[i] * p[i];
        s.xp += slope_x[i] * p[i];
        s.yp += slope_y[i] * p[i];
    }
    return s;
}

HV_MULTIVERSION
TemplateSums SumTemplateRows(const std::int16_t* __restrict g, const std::int16_t* __restrict x,
                             const std::int16_t* __restrict y) {
    TemplateSums s{};
    for (int i = 0; i < kArea; ++i) {
        s.g += g[i];
        s.x += x[i];
        s.y += y[i];
        s.gg += g[i] * g[i];
        s.xx += x[i] * x[i];
        s.xy += x[i] * y[i];
        s.yy += y[i] * y[i];
        s.gx += g[i] * x[i];
        s.gy += g[i] * y[i];
    }
    return s;
}

HV_MULTIVERSION
std::int32_t SumProductRows(const std::int16_t* __restrict a, const std::int16_t* __restrict b) {
    std::int32_t sum = 0;
    for (int i = 0; i < kArea; ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

void CutTemplate(const cv::Mat1b& image, int centre_x, int centre_y, TemplatePatch& t) {
    const auto step = static_cast<std::ptrdiff_t>(image.step1());
    const std::uint8_t* top_left = image[centre_y - kLeft] + centre_x - kLeft;
    const Pixels<kHeight + 2> pixels(top_left - step, step);
    const Pixels<kHeight> left(top_left - 1, step);
    const Pixels<kHeight> right(top_left + 1, step);
    CutRows(pixels.grey.data(), left.grey.data(), right.grey.data(), t);
}

TemplateSums SumTemplate(const TemplatePatch& t) {
    return SumTemplateRows(t.grey.value.data(), t.slope_x.value.data(), t.slope_y.value.data());
}

void SamplePatch(const cv::Mat1b& image, int centre_x, int centre_y, IntegerPatch& p) {
    const int left = centre_x - kLeft * kUnit;
    const int top = centre_y - kLeft * kUnit;
    const auto step = static_cast<std::ptrdiff_t>(image.step1());
    const std::uint8_t* top_left = image[top / kUnit] + left / kUnit;
    const Pixels<kHeight + 1> pixels(top_left, step);
    const Pixels<kHeight + 1> right(top_left + 1, step);
    const Fraction fraction{static_cast<std::uint16_t>(left % kUnit),
                            static_cast<std::uint16_t>(top % kUnit)};
    SampleRows(pixels.grey.data(), right.grey.data(), fraction, p.value.data());
}

SampleSums SumSample(const TemplatePatch& t, const IntegerPatch& p) {
    return SumRows(t.slope_x.value.data(), t.slope_y.value.data(), p.value.data());
}

std::int32_t SumProducts(const IntegerPatch& template_grey, const IntegerPatch& p) {
    return SumProductRows(template_grey.value.data(), p.value.data());
}

}  // namespace hitchview::algo
