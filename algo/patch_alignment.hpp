#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "algo/grey_pyramid.hpp"

namespace hitchview::algo {

struct PatchAlignmentOptions {
    int finest_level = 0;         ///< pyramid level where the search ends
    int max_steps = 12;           ///< per pyramid level
    float enough_px = 0.01F;      ///< a shorter step ends a level
    float min_strength = 1.0F;    ///< smaller eigenvalue of the mean structure tensor
    float max_travel_px = 12.0F;  ///< per level, in that level's pixels
};

struct PatchMatch {
    Eigen::Vector2f position_px;
    float correlation;  ///< of the two patches at the finest level, -1..1
};

/// Where the patch (16 x 15 px) around `from_px` of `from` lies in `to`, starting at `guess_px`,
/// from pyramid level `coarsest` down to `finest_level` (inverse compositional Lucas-Kanade; Baker
/// and Matthews, IJCV 2004). Brightness and contrast of the two pictures may differ: both patches
/// are brought to zero mean and equal deviation in every step. Empty when the patch has no texture,
/// leaves the picture or runs away. Levels where the patch does not fit into the picture are
/// skipped. Thread-safe.
std::optional<PatchMatch> AlignPatch(const GreyPyramid& from, const GreyPyramid& to,
                                     const Eigen::Vector2f& from_px,
                                     const Eigen::Vector2f& guess_px, int coarsest,
                                     const PatchAlignmentOptions& options);

}  // namespace hitchview::algo
