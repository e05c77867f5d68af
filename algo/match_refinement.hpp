#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace hitchview::algo {

/// Moves a match that is right to about a pixel to where the patches (7 x 7) round pixel (x, y) of
/// `from` and `found_px` of `to` agree best: a step of Lucas and Kanade with zero mean and equal
/// deviation, and another where the first is long, against a prior that the match is right to
/// 0.4 px (maximum a posteriori). So a patch that tells nothing leaves the match where it is.
/// Returns how much was told in x: 0 nothing .. 1; 0 too if a patch leaves its picture or the match
/// would move by more than 2 px. Thread-safe.
float RefineMatch(const cv::Mat1b& from, int x, int y, const cv::Mat1b& to,
                  Eigen::Vector2f& found_px);

}  // namespace hitchview::algo
