#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core/mat.hpp>

namespace hitchview::algo {

/// True if `point` lies in the picture and `mask` is not zero at its nearest pixel.
inline bool Allows(const cv::Mat1b& mask, const Eigen::Vector2f& point) {
    const auto x = static_cast<int>(std::lround(point.x()));
    const auto y = static_cast<int>(std::lround(point.y()));
    return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask(y, x) != 0;
}

}  // namespace hitchview::algo
