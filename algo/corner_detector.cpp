#include "algo/corner_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

/// Sobel derivatives are 8 times the slope.
constexpr float kSlopeScale = 1.0F / 64.0F;

/// Three neighbouring rows of a picture.
template <typename T>
struct Rows {
    const T* above;
    const T* here;
    const T* below;
};

template <typename T>
Rows<T> Around(const cv::Mat_<T>& picture, int y) {
    return {picture[y - 1], picture[y], picture[y + 1]};
}

/// Sobel derivatives of the inner pixels of a row.
HV_MULTIVERSION
void DeriveRow(const Rows<std::uint8_t>& rows, int width, std::int16_t* __restrict gx,
               std::int16_t* __restrict gy) {
    const std::uint8_t* __restrict a = rows.above;
    const std::uint8_t* __restrict h = rows.here;
    const std::uint8_t* __restrict b = rows.below;
    for (int x = 1; x < width - 1; ++x) {
        gx[x] = static_cast<std::int16_t>(a[x + 1] - a[x - 1] + 2 * (h[x + 1] - h[x - 1]) +
                                          b[x + 1] - b[x - 1]);
        gy[x] = static_cast<std::int16_t>(b[x - 1] - a[x - 1] + 2 * (b[x] - a[x]) + b[x + 1] -
                                          a[x + 1]);
    }
}

/// Replaces the products of an earlier row by g1 g2, and the column sums accordingly.
HV_MULTIVERSION
void ExchangeProducts(const std::int16_t* __restrict g1, const std::int16_t* __restrict g2,
                      int width, int* __restrict products, int* __restrict column_sums) {
    for (int x = 0; x < width; ++x) {
        const int product = g1[x] * g2[x];
        column_sums[x] += product - products[x];
        products[x] = product;
    }
}

/// Smaller eigenvalue of [a b; b c].
HV_MULTIVERSION
void SmallerEigenvalues(const float* __restrict a, const float* __restrict b,
                        const float* __restrict c, int count, float* __restrict smaller) {
    for (int x = 0; x < count; ++x) {
        const float difference = a[x] - c[x];
        smaller[x] = 0.5F * (a[x] + c[x] - std::sqrt(difference * difference + 4 * b[x] * b[x]));
    }
}

HV_MULTIVERSION
void BoxMeans(const int* __restrict sums, int count, float scale, float* __restrict means) {
    for (int x = 0; x < count; ++x) {
        const int sum = sums[x - 2] + sums[x - 1] + sums[x] + sums[x + 1] + sums[x + 2];
        means[x] = scale * static_cast<float>(sum);
    }
}

/// 1 where a pixel is at least `least` and the largest of 3 x 3; of equal ones the last counts.
HV_MULTIVERSION
void MarkPeaks(const Rows<float>& rows, int count, float least, std::uint8_t* __restrict peak) {
    const float* __restrict a = rows.above;
    const float* __restrict h = rows.here;
    const float* __restrict b = rows.below;
    for (int x = 0; x < count; ++x) {
        const float s = h[x];
        peak[x] = static_cast<std::uint8_t>(
            static_cast<int>(s >= least) & static_cast<int>(s >= h[x - 1]) &
            static_cast<int>(s > h[x + 1]) & static_cast<int>(s >= a[x - 1]) &
            static_cast<int>(s >= a[x]) & static_cast<int>(s >= a[x + 1]) &
            static_cast<int>(s > b[x - 1]) & static_cast<int>(s > b[x]) &
            static_cast<int>(s > b[x + 1]));
    }
}

/// Calls `found` with each place that is marked.
template <typename Found>
void ForEachMark(const std::uint8_t* marks, int count, Found&& found) {
    constexpr int kAtOnce = 8;
    for (int x = 0; x < count; x += kAtOnce) {
        const int here = std::min(kAtOnce, count - x);
        std::uint64_t any = 0;
        std::memcpy(&any, marks + x, static_cast<std::size_t>(here));
        for (int i = 0; any != 0 && i < here; ++i) {
            if (marks[x + i] != 0) found(x + i);
        }
    }
}

/// Unlike cv::Mat::setTo, which takes memory.
template <typename T>
void SetZero(cv::Mat_<T>& image) {
    std::fill_n(image[0], image.total(), T{0});
}

}  // namespace

CornerDetector::CornerDetector(int width_px, int height_px, const CornerDetectorOptions& options)
    : options_(options),
      strength_(height_px, width_px, 0.0F),
      products_(3 * kBox, width_px, 0),
      column_sums_(3, width_px, 0),
      slopes_(2, width_px, std::int16_t{0}),
      means_(3, width_px, 0.0F),
      marks_(1, width_px, std::uint8_t{0}),
      blocked_(height_px, width_px, std::uint8_t{0}) {}

void CornerDetector::Detect(const cv::Mat1b& image, const cv::Mat1b& mask,
                            std::span<const Eigen::Vector2f> taken, int wanted, Corners& corners) {
    corners.clear();
    MeasureStrength(image);
    const float best = CollectPeaks(mask);
    SetZero(blocked_);
    for (const Eigen::Vector2f& point : taken) BlockAround(point);
    ServeBuckets(std::max(options_.min_strength, options_.quality * best), wanted, corners);
}

void CornerDetector::MeasureStrength(const cv::Mat1b& image) {
    constexpr int kHalf = kBox / 2;
    SetZero(products_);
    SetZero(column_sums_);
    for (int y = 1; y + 1 < image.rows; ++y) {
        AddRow(image, y);
        if (y >= kBox) WriteStrengthRow(y - kHalf);
    }
}

void CornerDetector::AddRow(const cv::Mat1b& image, int y) {
    std::int16_t* gx = slopes_[0];
    std::int16_t* gy = slopes_[1];
    DeriveRow(Around(image, y), image.cols, gx, gy);
    const int slot = 3 * (y % kBox);
    ExchangeProducts(gx, gx, image.cols, products_[slot], column_sums_[0]);
    ExchangeProducts(gx, gy, image.cols, products_[slot + 1], column_sums_[1]);
    ExchangeProducts(gy, gy, image.cols, products_[slot + 2], column_sums_[2]);
}

void CornerDetector::WriteStrengthRow(int y) {
    constexpr int kFirst = kBox / 2 + 1;
    constexpr float kMean = kSlopeScale / (kBox * kBox);
    const int count = strength_.cols - 2 * kFirst;
    for (int k = 0; k < 3; ++k) BoxMeans(column_sums_[k] + kFirst, count, kMean, means_[k]);
    SmallerEigenvalues(means_[0], means_[1], means_[2], count, strength_[y] + kFirst);
}

float CornerDetector::CollectPeaks(const cv::Mat1b& mask) {
    for (Bucket& bucket : buckets_) {
        bucket.peaks.clear();
        bucket.next = 0;
    }
    float best = 0;
    const int border = std::max(options_.border_px, kBox / 2 + 2);
    const int count = strength_.cols - 2 * border;
    for (int y = border; y < strength_.rows - border; ++y) {
        const Rows<float> rows = Around(strength_, y);
        MarkPeaks({rows.above + border, rows.here + border, rows.below + border}, count,
                  options_.min_strength, marks_[0]);
        ForEachMark(marks_[0], count, [&](int i) {
            const int x = border + i;
            if (!mask.empty() && mask(y, x) == 0) return;
            best = std::max(best, strength_(y, x));
            KeepPeak(x, y);
        });
    }
    return best;
}

void CornerDetector::KeepPeak(int x, int y) {
    const int col = x * kBucketCols / strength_.cols;
    const int row = y * kBucketRows / strength_.rows;
    auto& peaks = buckets_[static_cast<std::size_t>(row * kBucketCols + col)].peaks;
    const Corner peak{{static_cast<float>(x), static_cast<float>(y)}, strength_(y, x)};
    if (peaks.full()) {
        if (peaks.back().strength >= peak.strength) return;
        peaks.pop_back();
    }
    peaks.push_back(peak);
    for (std::size_t i = peaks.size() - 1; i > 0 && peaks[i].strength > peaks[i - 1].strength;
         --i) {
        std::swap(peaks[i], peaks[i - 1]);
    }
}

void CornerDetector::BlockAround(const Eigen::Vector2f& point) {
    const int d = options_.min_distance_px;
    const int x0 = static_cast<int>(std::lround(point.x())) - d;
    const int y0 = static_cast<int>(std::lround(point.y())) - d;
    const cv::Rect all(0, 0, blocked_.cols, blocked_.rows);
    const cv::Rect around = cv::Rect(x0, y0, 2 * d + 1, 2 * d + 1) & all;
    for (int y = around.y; y < around.y + around.height; ++y)
        std::fill_n(blocked_[y] + around.x, around.width, std::uint8_t{1});
}

void CornerDetector::ServeBuckets(float min_strength, int wanted, Corners& corners) {
    for (bool any = true; any && corners.count() < wanted;) {
        any = false;
        for (Bucket& bucket : buckets_) {
            while (bucket.next < bucket.peaks.count()) {
                const Corner& peak = bucket.peaks[static_cast<std::size_t>(bucket.next++)];
                if (peak.strength < min_strength) {
                    bucket.next = bucket.peaks.count();
                    break;
                }
                const auto x = static_cast<int>(peak.position_px.x());
                const auto y = static_cast<int>(peak.position_px.y());
                if (blocked_(y, x) != 0) continue;
                if (corners.count() >= wanted || !corners.push_back(peak)) return;
                BlockAround(peak.position_px);
                any = true;
                break;
            }
        }
    }
}

}  // namespace hitchview::algo
