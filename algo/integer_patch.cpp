#include "algo/integer_patch.hpp"

#include <algorithm>
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
constexpr int kRowGreyUnit = 4;
static_assert(255 * kRowGreyUnit * kUnit + kUnit < 1 << 16);
constexpr int kMiddleGrey = 128;

/// Rows that a template is sampled from: one more above, one below, one more to blend with.
constexpr int kMaxRows = kHeight + 3;

struct Fraction {
    std::uint16_t x;
    std::uint16_t y;
};

/// Blends `rows` rows along themselves, each pixel with the one right of it, then with the row
/// below; `row`: the first of them.
HV_MULTIVERSION
void SampleRows(const std::uint8_t* row, std::ptrdiff_t step, Fraction f, int rows,
                std::int16_t* __restrict out) {
    constexpr int kRowScale = kUnit / kRowGreyUnit;
    constexpr int kRowHalf = kRowScale / 2;
    constexpr int kScale = kUnit * kRowGreyUnit / kGreyUnit;
    constexpr int kHalfScale = kScale / 2;
    alignas(32) std::uint16_t blended[kMaxRows * kWidth];
    const auto gx = static_cast<std::uint16_t>(kUnit - f.x);
    const auto gy = static_cast<std::uint16_t>(kUnit - f.y);
    for (int y = 0; y <= rows; ++y, row += step) {
        std::array<std::uint8_t, kWidth> left;  // copied: then the loop becomes one of vectors
        std::array<std::uint8_t, kWidth> right;
        std::memcpy(left.data(), row, kWidth);
        std::memcpy(right.data(), row + 1, kWidth);
        std::uint16_t* to = blended + y * kWidth;
        for (std::size_t x = 0; x < kWidth; ++x) {
            const auto sum = static_cast<std::uint16_t>(left[x] * gx + right[x] * f.x + kRowHalf);
            to[x] = static_cast<std::uint16_t>(sum / kRowScale);
        }
    }
    for (int i = 0; i < rows * kWidth; ++i) {
        const auto sum =
            static_cast<std::uint16_t>(blended[i] * gy + blended[i + kWidth] * f.y + kHalfScale);
        const auto grey = static_cast<std::int16_t>(sum / kScale);
        out[i] = static_cast<std::int16_t>(grey - kGreyUnit * kMiddleGrey);
    }
}

/// Of twice a slope in grey units; rounded down, which the mean that is subtracted later undoes.
HV_MULTIVERSION
void DifferRows(const std::int16_t* __restrict less, const std::int16_t* __restrict more,
                std::int16_t* __restrict slope) {
    constexpr int kShift = 2;
    static_assert(2 * kGreyUnit >> kShift == TemplatePatch::kSlopeUnit);
    for (int i = 0; i < kArea; ++i) {
        slope[i] = static_cast<std::int16_t>((more[i] - less[i]) >> kShift);
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

/// Where the samples round a centre, in units of 1 / kUnit px, are taken from.
struct Place {
    std::ptrdiff_t step;
    const std::uint8_t* top_left;
    Fraction fraction;

    Place(const cv::Mat1b& image, int centre_x, int centre_y)
        : step(static_cast<std::ptrdiff_t>(image.step1())),
          top_left(image[centre_y / kUnit - kLeft] + centre_x / kUnit - kLeft),
          fraction{static_cast<std::uint16_t>(centre_x % kUnit),
                   static_cast<std::uint16_t>(centre_y % kUnit)} {}
};

}  // namespace

void SamplePatch(const cv::Mat1b& image, int centre_x, int centre_y, IntegerPatch& p) {
    const Place place(image, centre_x, centre_y);
    SampleRows(place.top_left, place.step, place.fraction, kHeight, p.value.data());
}

void SampleTemplate(const cv::Mat1b& image, int centre_x, int centre_y, TemplatePatch& t) {
    const Place place(image, centre_x, centre_y);
    constexpr int kRows = kMaxRows - 1;
    alignas(32) std::array<std::int16_t, kRows * kWidth> less;
    alignas(32) std::array<std::int16_t, kRows * kWidth> more;
    SampleRows(place.top_left - 1, place.step, place.fraction, kHeight, less.data());
    SampleRows(place.top_left + 1, place.step, place.fraction, kHeight, more.data());
    DifferRows(less.data(), more.data(), t.slope_x.value.data());
    SampleRows(place.top_left - place.step, place.step, place.fraction, kRows, more.data());
    DifferRows(more.data(), more.data() + 2 * kWidth, t.slope_y.value.data());
    std::copy_n(more.begin() + kWidth, kArea, t.grey.value.begin());
}

TemplateSums SumTemplate(const TemplatePatch& t) {
    return SumTemplateRows(t.grey.value.data(), t.slope_x.value.data(), t.slope_y.value.data());
}

SampleSums SumSample(const TemplatePatch& t, const IntegerPatch& p) {
    return SumRows(t.slope_x.value.data(), t.slope_y.value.data(), p.value.data());
}

std::int32_t SumProducts(const IntegerPatch& template_grey, const IntegerPatch& p) {
    return SumProductRows(template_grey.value.data(), p.value.data());
}

}  // namespace hitchview::algo
