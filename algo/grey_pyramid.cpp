#include "algo/grey_pyramid.hpp"

#include <algorithm>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

constexpr int kMargin = 2;

int Mirror(int i, int n) {
    if (i < 0) return -i;
    return i < n ? i : 2 * n - 2 - i;
}

using FiveRows = std::array<const std::uint8_t*, 5>;

/// [1 4 6 4 1].
HV_MULTIVERSION
void SumFive(const FiveRows& rows, int count, std::uint16_t* __restrict sums) {
    const auto [a, b, c, d, e] = rows;
    for (int x = 0; x < count; ++x)
        sums[x] = static_cast<std::uint16_t>(a[x] + e[x] + 4 * (b[x] + d[x]) + 6 * c[x]);
}

/// The same beside each other, of every second column, and divided by the sum of all weights.
HV_MULTIVERSION
void HalveRow(const std::uint16_t* __restrict sums, int count, std::uint8_t* __restrict out) {
    for (int x = 0; x < count; ++x) {
        const std::uint16_t* s = sums + 2 * x;
        const int sum = s[-2] + s[2] + 4 * (s[-1] + s[1]) + 6 * s[0];
        out[x] = static_cast<std::uint8_t>((sum + 128) >> 8);
    }
}

/// One row of vertical sums, with two mirrored entries on each side.
void SumColumns(const cv::Mat1b& fine, int row, std::uint16_t* sums) {
    FiveRows rows{};
    for (int k = 0; k < 5; ++k)
        rows[static_cast<std::size_t>(k)] = fine[Mirror(row + k - 2, fine.rows)];
    std::uint16_t* out = sums + kMargin;
    const int n = fine.cols;
    SumFive(rows, n, out);
    out[-1] = out[1];
    out[-2] = out[2];
    out[n] = out[n - 2];
    out[n + 1] = out[n - 3];
}

void Halve(const cv::Mat1b& fine, cv::Mat1b& coarse, std::uint16_t* sums) {
    for (int y = 0; y < coarse.rows; ++y) {
        SumColumns(fine, 2 * y, sums);
        HalveRow(sums + kMargin, coarse.cols, coarse[y]);
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
