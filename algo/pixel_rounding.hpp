#pragma once

#include <Eigen/Core>

namespace hitchview::algo {

/// The nearest whole numbers of a place in a picture; what is negative comes out anywhere up to 0.
/// Unlike std::lround no call where a processor's baseline cannot round.
inline Eigen::Vector2i Round(const Eigen::Vector2f& place) {
    return (place.array() + 0.5F).cast<int>();
}

}  // namespace hitchview::algo
