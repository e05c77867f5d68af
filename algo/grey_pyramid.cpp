#include "algo/grey_pyramid.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

constexpr int kMargin = 2;

int Mirror(int i, int n) {
    if (i < 0) return -i;
    return i < n ? i : 2 * n - 2 - i;
}

/// One row of vertical sums [1 4 6 4 1], with two mirrored entries on each side.
void SumColumns(const cv::Mat1b& fine, int row, std::uint16_t* sums) {
    std::array<const std::uint8_t*, 5> r{};
    for (int k = 0; k < 5; ++k)
        r[static_cast<std::size_t>(k)] = fine[Mirror(row + k - 2, fine.rows)];
    std::uint16_t* out = sums + kMargin;
    const int n = fine.cols;
    for (int x = 0; x < n; ++x) {
        out[x] =
            static_cast<std::uint16_t>(r[0][x] + r[4][x] + 4 * (r[1][x] + r[3][x]) + 6 * r[2][x]);
    }
    out[-1] = out[1];
    out[-2] = out[2];
    out[n] = out[n - 2];
    out[n + 1] = out[n - 3];
}

void Halve(const cv::Mat1b& fine, cv::Mat1b& coarse, std::uint16_t* sums) {
    for (int y = 0; y < coarse.rows; ++y) {
        SumColumns(fine, 2 * y, sums);
        const std::uint16_t* s = sums + kMargin;
        std::uint8_t* out = coarse[y];
        for (int x = 0; x < coarse.cols; ++x) {
            const int i = 2 * x;
            const int sum = s[i - 2] + s[i + 2] + 4 * (s[i - 1] + s[i + 1]) + 6 * s[i];
            out[x] = static_cast<std::uint8_t>((sum + 128) >> 8);
        }
    }
}

}  // namespace

GreyPyramid::GreyPyramid(int width_px, int height_px)
    : column_sums_(1, width_px + 2 * kMargin, std::uint16_t{0}) {
    constexpr int kShortestSide = 24;
    levels_[0] = cv::Mat1b(height_px, width_px, std::uint8_t{0});
    while (count_ < kMaxLevels) {
        const cv::Mat1b& fine = levels_[static_cast<std::size_t>(count_ - 1)];
        if ((std::min(fine.cols, fine.rows) + 1) / 2 < kShortestSide) break;
        levels_[static_cast<std::size_t>(count_++)] =
            cv::Mat1b((fine.rows + 1) / 2, (fine.cols + 1) / 2, std::uint8_t{0});
    }
}

void GreyPyramid::Build() {
    for (int l = 1; l < count_; ++l) {
        Halve(level(l - 1), levels_[static_cast<std::size_t>(l)], column_sums_[0]);
    }
}

}  // namespace hitchview::algo
