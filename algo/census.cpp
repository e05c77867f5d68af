#include "algo/census.hpp"

#include <algorithm>

namespace hitchview::algo {

void Census::Build(const cv::Mat1b& picture, int first, int last) {
    const int from = std::max(first, kHalf);
    const int to = std::min(last, picture.cols - 1 - kHalf);
    for (int y = kHalf; y < picture.rows - kHalf; ++y) {
        std::uint64_t* out = signatures_.data() + static_cast<std::ptrdiff_t>(y) * width_px_;
        const std::uint8_t* centre = picture[y];
        std::fill(out + from, out + std::max(from, to + 1), 0);
        for (int dy = -kHalf; dy <= kHalf; ++dy) {
            const std::uint8_t* row = picture[y + dy];
            for (int dx = -kHalf; dx <= kHalf; ++dx) {
                if (dx == 0 && dy == 0) continue;
                for (int x = from; x <= to; ++x) {
                    out[x] = out[x] << 1U | static_cast<std::uint64_t>(row[x + dx] < centre[x]);
                }
            }
        }
    }
}

}  // namespace hitchview::algo
