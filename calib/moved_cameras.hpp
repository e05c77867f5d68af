#pragma once

#include <vector>

#include "calib/pair_turn.hpp"

namespace hitchview::calib {

/// A camera that was turned since it was calibrated.
struct MovedCamera {
    std::size_t camera = 0;
    double turn_rad = 0;  ///< at least, as far as it shows
};

/// Who must have moved for all pairs to see what they see, to within `limit_rad`: the fewest
/// cameras that do. Several answers where pairs cannot tell them apart, as at the open end of a row
/// of cameras, where the last one and its neighbour explain the same. One answer of no camera: none
/// moved. Empty: not even three moved cameras explain it.
std::vector<std::vector<MovedCamera>> ExplainByMoves(std::size_t cameras,
                                                     const std::vector<PairTurn>& pairs,
                                                     double limit_rad);

}  // namespace hitchview::calib
