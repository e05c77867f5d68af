#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "algo/grey_pyramid.hpp"

namespace hitchview::algo {

/// 256 brightness comparisons between pairs of points around a corner (BRIEF; Calonder et al.,
/// ECCV 2010). Upright: cameras of a vehicle are not turned against each other by more than a few
/// degrees. Brightness and contrast of the picture do not matter.
struct PatchDescriptor {
    std::array<std::uint64_t, 4> bits{};

    [[nodiscard]] int Distance(const PatchDescriptor& other) const {
        int distance = 0;
        for (std::size_t i = 0; i < bits.size(); ++i) {
            distance += __builtin_popcountll(bits[i] ^ other.bits[i]);
        }
        return distance;
    }
};

/// The descriptor at `point_px` (pixels of `level`); compares pixels of the next coarser level,
/// which is the smoothing that the comparisons need. Empty too near the edge, or on the last level.
std::optional<PatchDescriptor> DescribePatch(const GreyPyramid& pyramid, int level,
                                             const Eigen::Vector2f& point_px);

}  // namespace hitchview::algo
