#pragma once

#include <string>

#include "algo/camera_model.hpp"
#include "calib/verdict.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {

/// The keys of a lens in every file that has one: model, size_px, focal_px, centre_px, distortion,
/// max_theta_rad. Complains where a value is outside its range or the distortion has no inverse.
algo::CameraModel ReadCameraModel(YamlMap& map);

/// pass, fail or unchecked.
void ReadVerdict(const YamlValue& value, Verdict& verdict);

/// The same keys, each behind `line_start`, number for number.
std::string CameraModelText(const algo::CameraModel& model, const std::string& line_start);

}  // namespace hitchview::calib
