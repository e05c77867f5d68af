#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "algo/unit_geometry.hpp"
#include "calib/unit_session.hpp"
#include "calib/unit_solver.hpp"

namespace hitchview::app {

/// The semi-surround view of a unit as calibrated: a ring of 4096 x 1024 pixels, aligned at
/// infinity; forward in the middle of a tractor's, backward in that of a trailer's.
algo::UnitGeometry SemiSurroundOf(const calib::UnitSession& session,
                                  const calib::UnitSolution& solution);

/// Pictures of one moment in it, in colour; black where no camera sees anything.
cv::Mat3b DrawView(const algo::UnitGeometry& geometry, std::span<const cv::Mat> pictures);

/// What of a view lies about the middle between the axes of two of its cameras, at the horizon.
cv::Mat3b CropSeam(const algo::UnitGeometry& geometry, const cv::Mat3b& view,
                   const Eigen::Isometry3d& T_unit_first, const Eigen::Isometry3d& T_unit_second);

/// Writes where each camera is shown: `FOLDER/CAMERA.tiff`, as large as the view, three 32-bit
/// floats for each pixel: column and row in the camera's picture and its share, 0..1; -1, -1, 0
/// where it has none. Empty on success, otherwise what went wrong.
std::string WriteMaps(const algo::UnitGeometry& geometry, const std::vector<std::string>& names,
                      const std::filesystem::path& folder);

}  // namespace hitchview::app
