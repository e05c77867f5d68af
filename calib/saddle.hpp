#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace hitchview::calib {

/// Where two dark and two white quarters of a board are expected to meet in a picture.
struct ExpectedSaddle {
    Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
    /// How far the quarters reach along the board's rows and columns, as vectors in the picture:
    /// nearer there is nothing else.
    Eigen::Vector2d along_px = Eigen::Vector2d::Zero();
    Eigen::Vector2d down_px = Eigen::Vector2d::Zero();
    bool top_left_dark = true;  ///< and the bottom right; otherwise the other two
};

/// Where they meet, to some hundredths of a pixel; empty where something else is seen, too small,
/// too far away, or at the picture's edge. Thread-safe.
std::optional<Eigen::Vector2d> FindSaddle(const cv::Mat& grey, const ExpectedSaddle& expected);

}  // namespace hitchview::calib
