#pragma once

#include <vector>

#include "calib/lens_solver.hpp"

namespace hitchview::calib {

/// How far a distant point may be from where the model shows it.
struct PixelUncertainty {
    Eigen::Vector2d at_px{};
    double sigma_px = 0;  ///< standard deviation, mean over both directions
};

/// Over a grid of `columns` x `rows` places in the picture; places without a direction are left
/// out. What a turn of the whole camera would do is taken out first: it belongs to the camera's
/// place, not to its lens. The idea: mrcal's documentation, "Projection uncertainty".
std::vector<PixelUncertainty> ProjectionUncertainty(const algo::CameraModel& model,
                                                    const LensCovariance& covariance, int columns,
                                                    int rows);

}  // namespace hitchview::calib
