#include "algo/census.hpp"

#include <algorithm>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

/// The neighbours of a pixel, as rows and columns away from it.
constexpr auto kNeighbours = [] {
    std::array<std::array<int, 2>, Census::kBits> neighbours{};
    std::size_t i = 0;
    for (int dy = -Census::kHalf; dy <= Census::kHalf; ++dy) {
        for (int dx = -Census::kHalf; dx <= Census::kHalf; ++dx) {
            if (dy != 0 || dx != 0) neighbours[i++] = {dy, dx};
        }
    }
    return neighbours;
}();

/// Eight bits of each pixel of a row.
HV_MULTIVERSION
void CompareEight(const std::uint8_t* __restrict centre,
                  const std::array<const std::uint8_t*, 8>& neighbour, int count,
                  std::uint8_t* __restrict bits) {
    const auto [a, b, c, d, e, f, g, h] = neighbour;
    for (int x = 0; x < count; ++x) {
        const std::uint8_t grey = centre[x];
        const auto bit = [&](const std::uint8_t* p, unsigned value) {
            return static_cast<std::uint8_t>(p[x] < grey ? value : 0U);
        };
        bits[x] = static_cast<std::uint8_t>(bit(a, 1) | bit(b, 2) | bit(c, 4) | bit(d, 8) |
                                            bit(e, 16) | bit(f, 32) | bit(g, 64) | bit(h, 128));
    }
}

/// Signatures of a row from their bytes.
HV_MULTIVERSION
void Pack(const std::array<const std::uint8_t*, Census::kBytes>& bytes, const std::uint8_t* allowed,
          int count, std::uint64_t* __restrict out) {
    const auto [a, b, c, d, e, f] = bytes;
    for (int x = 0; x < count; ++x) {
        const auto half = [&](const std::uint8_t* p, const std::uint8_t* q, const std::uint8_t* r) {
            return static_cast<std::uint32_t>(p[x] << 16U | q[x] << 8U | r[x]);
        };
        const std::uint64_t signature = std::uint64_t{half(a, b, c)} << 24U | half(d, e, f);
        out[x] = allowed[x] != 0 ? signature : Census::kNone;
    }
}

}  // namespace

Census::Census(int width_px, int height_px)
    : width_px_(width_px),
      signatures_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), kNone) {
    bytes_.fill(std::vector<std::uint8_t>(static_cast<std::size_t>(width_px)));
}

void Census::Build(const cv::Mat1b& picture, const cv::Mat1b& mask, int first, int last,
                   int pitch) {
    const int from = std::max(first, kHalf);
    const int to = std::min(last, picture.cols - 1 - kHalf) + 1;
    for (int y = (kHalf + pitch - 1) / pitch * pitch; y < picture.rows - kHalf; y += pitch) {
        CompareRow(picture, y, from, to);
        std::array<const std::uint8_t*, kBytes> bytes;
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = bytes_[i].data() + from;
        Pack(bytes, mask[y] + from, to - from,
             signatures_.data() + static_cast<std::ptrdiff_t>(y) * width_px_ + from);
    }
}

void Census::CompareRow(const cv::Mat1b& picture, int y, int from, int to) {
    for (std::size_t i = 0; i < bytes_.size(); ++i) {
        std::array<const std::uint8_t*, 8> neighbour;
        for (std::size_t bit = 0; bit < neighbour.size(); ++bit) {
            const auto [dy, dx] = kNeighbours[8 * i + bit];
            neighbour[bit] = picture[y + dy] + from + dx;
        }
        CompareEight(picture[y] + from, neighbour, to - from, bytes_[i].data() + from);
    }
}

}  // namespace hitchview::algo
