#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "calib/board.hpp"

namespace hitchview::calib {

/// How a board's corners look in a picture.
struct CornerLook {
    double blur_px = 0;     ///< standard deviation of a Gaussian that would blur edges so; median
    double dark_grey = 0;   ///< of the ink; median
    double white_grey = 0;  ///< of the paper; median
};

/// Empty where there are no corners.
std::optional<CornerLook> LookAtCorners(const cv::Mat& grey, const SeenCorners& corners);

/// To which side a board leans away from the camera.
enum class Tilt { kFacing, kLeftAway, kRightAway, kTopAway, kBottomAway };
inline constexpr int kTilts = 5;

/// How a board is held, as far as its corners tell without knowing the lens.
struct BoardPose {
    Tilt tilt = Tilt::kFacing;
    /// The longer side of the whole board against that of the picture, were all of it to be seen.
    double size = 0;
};

/// From a homography over all corners. Empty: fewer than four, or in a line.
std::optional<BoardPose> RoughPose(const Board& board, const SeenCorners& corners,
                                   const Eigen::Vector2d& picture_px);

}  // namespace hitchview::calib
