#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "algo/unit.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// One unit's recordings; an empty path is one that there is not.
struct UnitVideos {
    std::string in;   ///< as the camera saw it; one camera only
    std::string out;  ///< warped and placed on the panorama's canvas, before blending
};

struct EvaluationOptions {
    algo::PerUnit<UnitVideos> units{};
    std::string panorama{};
    int step = 1;  ///< every so many-th frame is matched for cropping, distortion and seams. >= 1
    std::function<void(int)> progress = [](int /*frames*/) {};  ///< called after each frame set
};

/// Quality measured from the pixels. Frame i of every video belongs to set i; the shortest one
/// ends.
///   units.<unit>: cropping_mean cropping_min distortion_min distortion_p01 distortion_eigen_min
///     stability stability_in stability_detrended stability_frames jitter_ratio jerk_in_px
///     jerk_out_px rot_jerk_out_rad frames_unmatched frames_lost frames_repeated
///   seams.<left|right>: median_px p95_px worst_frame_px horizontal_median_px vertical_median_px
///     measured_share locked_share
///   panorama: stability jerk_px
///   frames
/// What cannot be known from these videos is null (locked_share always is: it is a state of the
/// pipeline). Refused: a video that cannot be read, a damaged frame, layers of different sizes.
hal::Checked<nlohmann::json> Evaluate(const EvaluationOptions& options);

}  // namespace hitchview::app
