#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>

#include "algo/fixed_vector.hpp"

namespace hitchview::algo {

struct Corner {
    Eigen::Vector2f position_px;
    float strength;  ///< smaller eigenvalue of the mean structure tensor, grey levels^2 / px^2
};

struct CornerDetectorOptions {
    float min_strength = 4.0F;  ///< weaker corners are noise
    float quality = 0.004F;     ///< and so are those below this share of the picture's best
    int min_distance_px = 7;    ///< between corners, and to the features already there
    int border_px = 10;         ///< no corner closer to the edge of the picture
};

/// Shi-Tomasi corners, spread over a grid of buckets. Memory is taken at construction.
class CornerDetector {
 public:
    static constexpr int kMaxCorners = 1024;
    using Corners = FixedVector<Corner, kMaxCorners>;

    CornerDetector(int width_px, int height_px, const CornerDetectorOptions& options);

    /// Replaces `corners` by at most `wanted` corners of `image` where `mask` is not zero (an empty
    /// mask allows everything), none near a point of `taken`. Buckets are served in turns, so that
    /// no part of the picture gets all of them; order is strongest first within a turn.
    void Detect(const cv::Mat1b& image, const cv::Mat1b& mask,
                std::span<const Eigen::Vector2f> taken, int wanted, Corners& corners);

    /// Strength of every pixel in the last call, 0 at the border.
    [[nodiscard]] const cv::Mat1f& strength() const { return strength_; }

 private:
    void MeasureStrength(const cv::Mat1b& image);
    void AddRow(const cv::Mat1b& image, int y);
    void WriteStrengthRow(int y);
    float CollectPeaks(const cv::Mat1b& mask);
    void KeepPeak(int x, int y);
    void BlockAround(const Eigen::Vector2f& point);
    void ServeBuckets(float min_strength, int wanted, Corners& corners);

    static constexpr int kBox = 5;  // side of the window the structure tensor is averaged over
    static constexpr int kBucketCols = 16;
    static constexpr int kBucketRows = 8;
    static constexpr int kPeaksPerBucket = 24;
    struct Bucket {
        FixedVector<Corner, kPeaksPerBucket> peaks;  // strongest first
        int next = 0;
    };

    CornerDetectorOptions options_;
    cv::Mat1f strength_;
    cv::Mat1i products_;             // gx gx, gx gy, gy gy of the last kBox rows
    cv::Mat1i column_sums_;          // of those rows
    cv::Mat_<std::int16_t> slopes_;  // gx, gy of a row; 0 at its ends
    cv::Mat1f means_;                // of gx gx, gx gy, gy gy round the pixels of a row
    cv::Mat1b marks_;                // peaks of a row
    cv::Mat1b blocked_;
    std::array<Bucket, kBucketCols * kBucketRows> buckets_;
};

}  // namespace hitchview::algo
