#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

namespace hitchview::algo {

/// Where to look for a patch along the row of the other view.
struct ParallaxRange {
    float from_px = 0;  ///< shift in x of what lies farthest
    float to_px = 0;    ///< of what lies nearest; may be smaller than from_px
};

struct ParallaxSearchOptions {
    float min_correlation = 0.85F;
    float min_lead = 0.04F;      ///< over the best place elsewhere on the row
    float habit = 0.05F;         ///< bonus of the place that was expected
    float habit_px = 2.5F;       ///< how near to it
    float min_deviation = 3.0F;  ///< of the patch, grey levels
};

/// Finds a patch of one grey picture in another along a row: normalised cross-correlation at every
/// pixel of the range. It finds what a gradient search from far away does not: thin near things,
/// whose parallax is many times their width. Position to a pixel in x, unchanged in y. Empty
/// without texture, without a clear best place, or near the border. Thread-safe.
std::optional<Eigen::Vector2f> SearchAlongRow(const cv::Mat1b& from, const cv::Mat1b& to,
                                              const Eigen::Vector2f& at_px,
                                              const Eigen::Vector2f& base_px,
                                              const Eigen::Vector2f& expected_px,
                                              const ParallaxRange& range,
                                              const ParallaxSearchOptions& options = {});

}  // namespace hitchview::algo
