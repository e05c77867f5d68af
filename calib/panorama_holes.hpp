#pragma once

#include <string>
#include <vector>

#include "algo/projection.hpp"
#include "algo/unit_geometry.hpp"
#include "calib/rig_calibration.hpp"

namespace hitchview::calib {

/// What no camera covers between two that look in neighbouring directions.
struct SeamHole {
    std::string right{};        ///< camera clockwise of the seam, seen from above
    std::string left{};         ///< the next one counterclockwise
    int uncovered_px = 0;       ///< pixels of the panorama
    int gap_at_horizon_px = 0;  ///< columns with an uncovered pixel within 5 degrees of the horizon
};

/// For each seam of a panorama of the rig, the units in line; in the order of the azimuth.
/// `canvas`: a ring. A rig has 1..kMaxCameras cameras, in any of its units.
std::vector<SeamHole> FindHoles(const RigCalibration& calibration, const algo::Projection& canvas,
                                const algo::AlignmentSurface& surface);

}  // namespace hitchview::calib
