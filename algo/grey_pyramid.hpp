#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>

namespace hitchview::algo {

/// Grey picture at full, half, quarter ... size. Level l's pixel x lies at 2^l x of level 0.
/// Memory is taken at construction.
class GreyPyramid {
 public:
    static constexpr int kMaxLevels = 5;

    /// As many levels, at most kMaxLevels, as keep the shorter side at 24 px or more.
    GreyPyramid(int width_px, int height_px);

    /// The picture; write it, then call Build.
    cv::Mat1b& base() { return levels_[0]; }
    /// Makes levels 1.. from level 0: 5-tap binomial filter [1 4 6 4 1]/16 in both directions,
    /// every second pixel, mirrored at the border without repeating it (as cv::pyrDown).
    void Build();

    [[nodiscard]] int levels() const { return count_; }
    [[nodiscard]] const cv::Mat1b& level(int l) const {
        return levels_[static_cast<std::size_t>(l)];
    }

    friend void swap(GreyPyramid& a, GreyPyramid& b) noexcept {
        std::swap(a.levels_, b.levels_);
        std::swap(a.count_, b.count_);
        std::swap(a.column_sums_, b.column_sums_);
    }

 private:
    int count_ = 1;
    std::array<cv::Mat1b, kMaxLevels> levels_;
    cv::Mat_<std::uint16_t> column_sums_;
};

}  // namespace hitchview::algo
