#pragma once

#include <nlohmann/json.hpp>

#include "app/calib_pictures.hpp"
#include "calib/intrinsics.hpp"

namespace hitchview::app {

/// All figures of a measured lens (docs/calibration.md).
nlohmann::json IntrinsicsJson(const calib::Intrinsics& lens, const BoardPictures& pictures);

/// The same for a person, on stdout.
void PrintIntrinsics(const calib::Intrinsics& lens, const BoardPictures& pictures);

}  // namespace hitchview::app
