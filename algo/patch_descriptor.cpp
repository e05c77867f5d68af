#include "algo/patch_descriptor.hpp"

#include <cmath>

namespace hitchview::algo {
namespace {

constexpr int kComparisons = 256;
constexpr int kReach = 9;  // px of the coarser level, to each side

struct Comparison {
    std::int8_t x0, y0, x1, y1;
};

/// Point pairs from an isotropic bell curve (Calonder's best pattern), drawn once from a fixed
/// seed: the sum of three dice of -3..3.
constexpr std::array<Comparison, kComparisons> MakePattern() {
    std::uint32_t state = 2463534242U;
    const auto die = [&state] {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        return static_cast<int>(state % 7U) - 3;
    };
    std::array<Comparison, kComparisons> pattern{};
    for (Comparison& c : pattern) {
        do {
            const auto draw = [&die] { return static_cast<std::int8_t>(die() + die() + die()); };
            c = {draw(), draw(), draw(), draw()};
        } while (c.x0 == c.x1 && c.y0 == c.y1);
    }
    return pattern;
}

constexpr auto kPattern = MakePattern();

}  // namespace

std::optional<PatchDescriptor> DescribePatch(const GreyPyramid& pyramid, int level,
                                             const Eigen::Vector2f& point_px) {
    if (level + 1 >= pyramid.levels()) return std::nullopt;
    const cv::Mat1b& image = pyramid.level(level + 1);
    const auto x = static_cast<int>(std::lround(point_px.x() * 0.5F));
    const auto y = static_cast<int>(std::lround(point_px.y() * 0.5F));
    if (x < kReach || y < kReach || x >= image.cols - kReach || y >= image.rows - kReach) {
        return std::nullopt;
    }
    const std::uint8_t* centre = image[y] + x;
    const auto stride = static_cast<std::ptrdiff_t>(image.step1());
    PatchDescriptor descriptor;
    for (std::size_t i = 0; i < kComparisons; ++i) {
        const Comparison& c = kPattern[i];
        const bool darker = centre[c.y0 * stride + c.x0] < centre[c.y1 * stride + c.x1];
        descriptor.bits[i / 64] |= static_cast<std::uint64_t>(darker) << (i % 64);
    }
    return descriptor;
}

}  // namespace hitchview::algo
