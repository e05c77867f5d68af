#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hitchview::algo {

/// What a pixel's neighbourhood looks like, whatever the exposure: one bit for each of the 48
/// pixels round it in a square of 7 x 7, set where that one is darker (census transform; Zabih and
/// Woodfill, ECCV 1994). Two signatures differ by the number of bits that differ.
class Census {
 public:
    static constexpr int kHalf = 3;
    static constexpr int kBits = (2 * kHalf + 1) * (2 * kHalf + 1) - 1;

    Census(int width_px, int height_px)
        : width_px_(width_px),
          signatures_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {}

    /// Of the columns from `first` to `last` (both included) of a picture of the size given; kHalf
    /// pixels at its border have no signature.
    void Build(const cv::Mat1b& picture, int first, int last);

    [[nodiscard]] std::uint64_t At(int x, int y) const {
        return signatures_[static_cast<std::size_t>(y * width_px_ + x)];
    }

 private:
    int width_px_;
    std::vector<std::uint64_t> signatures_;
};

}  // namespace hitchview::algo
