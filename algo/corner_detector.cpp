#include "algo/corner_detector.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

/// Sobel derivatives are 8 times the slope.
constexpr float kSlopeScale = 1.0F / 64.0F;

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
    const std::uint8_t* above = image[y - 1];
    const std::uint8_t* here = image[y];
    const std::uint8_t* below = image[y + 1];
    const int slot = 3 * (y % kBox);
    std::array<int*, 3> product{products_[slot], products_[slot + 1], products_[slot + 2]};
    std::array<int*, 3> sum{column_sums_[0], column_sums_[1], column_sums_[2]};
    for (int x = 1; x + 1 < image.cols; ++x) {
        const int gx = above[x + 1] - above[x - 1] + 2 * (here[x + 1] - here[x - 1]) +
                       below[x + 1] - below[x - 1];
        const int gy =
            below[x - 1] - above[x - 1] + 2 * (below[x] - above[x]) + below[x + 1] - above[x + 1];
        const std::array<int, 3> now{gx * gx, gx * gy, gy * gy};
        for (std::size_t k = 0; k < 3; ++k) {
            sum[k][x] += now[k] - product[k][x];
            product[k][x] = now[k];
        }
    }
}

void CornerDetector::WriteStrengthRow(int y) {
    constexpr int kHalf = kBox / 2;
    constexpr float kMean = kSlopeScale / (kBox * kBox);
    const auto box = [](const int* s, int x) {
        return kMean * static_cast<float>(s[x - 2] + s[x - 1] + s[x] + s[x + 1] + s[x + 2]);
    };
    const int* xx = column_sums_[0];
    const int* xy = column_sums_[1];
    const int* yy = column_sums_[2];
    float* out = strength_[y];
    for (int x = kHalf + 1; x < strength_.cols - kHalf - 1; ++x) {
        const float a = box(xx, x);
        const float b = box(xy, x);
        const float c = box(yy, x);
        out[x] = 0.5F * (a + c - std::sqrt((a - c) * (a - c) + 4 * b * b));
    }
}

float CornerDetector::CollectPeaks(const cv::Mat1b& mask) {
    for (Bucket& bucket : buckets_) {
        bucket.peaks.clear();
        bucket.next = 0;
    }
    float best = 0;
    const int border = std::max(options_.border_px, kBox / 2 + 2);
    for (int y = border; y < strength_.rows - border; ++y) {
        const float* above = strength_[y - 1];
        const float* here = strength_[y];
        const float* below = strength_[y + 1];
        for (int x = border; x < strength_.cols - border; ++x) {
            const float s = here[x];
            if (s < options_.min_strength || s < here[x - 1] || s <= here[x + 1] || s < above[x] ||
                s <= below[x] || s < above[x - 1] || s < above[x + 1] || s <= below[x - 1] ||
                s <= below[x + 1]) {
                continue;
            }
            if (!mask.empty() && mask(y, x) == 0) continue;
            best = std::max(best, s);
            KeepPeak(x, y);
        }
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
