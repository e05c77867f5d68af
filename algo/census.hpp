#pragma once

#include <array>
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
    static constexpr int kBytes = kBits / 8;
    /// Set in what stands in for a signature where there is none, and nowhere else.
    static constexpr std::uint64_t kNone = std::uint64_t{1} << 63U;

    Census(int width_px, int height_px);

    /// Of every `pitch`th row, from row 0, and the columns from `first` to `last` (both included)
    /// of a picture of the size given. There is no signature where `mask` is 0, nor ever in the
    /// kHalf pixels at the border.
    void Build(const cv::Mat1b& picture, const cv::Mat1b& mask, int first, int last, int pitch);

    [[nodiscard]] std::uint64_t At(int x, int y) const {
        return signatures_[static_cast<std::size_t>(y * width_px_ + x)];
    }
    /// All signatures, row by row; what Build was not asked for is of no meaning.
    [[nodiscard]] const std::uint64_t* data() const { return signatures_.data(); }

 private:
    void CompareRow(const cv::Mat1b& picture, int y, int from, int to);

    int width_px_;
    std::vector<std::uint64_t> signatures_;
    std::array<std::vector<std::uint8_t>, kBytes> bytes_;  // of the signatures of one row
};

}  // namespace hitchview::algo
