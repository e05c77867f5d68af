#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "algo/pixel_rounding.hpp"

namespace hitchview::algo {

/// True if `point` lies in the picture and `mask` is not zero at its nearest pixel.
inline bool Allows(const cv::Mat1b& mask, const Eigen::Vector2f& point) {
    if (!(point.x() > -0.5F && point.y() > -0.5F)) return false;
    const Eigen::Vector2i at = Round(point);
    return at.x() < mask.cols && at.y() < mask.rows && mask(at.y(), at.x()) != 0;
}

}  // namespace hitchview::algo
