#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "algo/unit.hpp"
#include "app/evaluation_seam.hpp"
#include "app/evaluation_view.hpp"
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

struct Quality {
    nlohmann::json figures;                  ///< see Evaluate
    algo::PerUnit<WorstView> worst_views{};  ///< without pictures where nothing was measured
    algo::PerOverlap<WorstSeam> worst_seams{};
};

/// Quality measured from the pixels. Frame i of every video belongs to set i; the shortest one
/// ends.
///   units.<unit>: cropping_mean cropping_min distortion_min distortion_p01 distortion_eigen_min
///     kept_mean kept_min stability stability_in stability_parts.{translation, rotation}
///     stability_detrended stability_detrended_in stability_detrended_parts stability_frames
///     jitter_ratio jerk_in_px jerk_out_px rot_jerk_in_rad rot_jerk_out_rad frames_unmatched
///     frames_lost frames_repeated
///     paper.{cropping, distortion, stability, stability_in}
///   seams.<left|right>: median_px p95_px worst_frame_px horizontal_median_px horizontal_p95_px
///     vertical_median_px vertical_p95_px measured_share locked_share paper.stitching_score_px
///   panorama: stability jerk_px coverage_mean coverage_min common_rectangle_share
///   recordings: the paths given, units.<unit>.{in, out} and panorama
///   frames
///   series: rate_hz step
///     units.<unit>.{in, out}: x_px y_px rotation_rad (one per frame), spectrum.{hz, amplitude_px}
///     units.<unit>.view: frame kept cropping distortion distortion_eigen (of the dominant plane),
///       picture.{cropping, distortion, distortion_eigen} (of the whole picture)
///     seams.<left|right>: frame pairs mean_px p95_px
///     panorama: frame coverage
/// What cannot be known from these videos is null (locked_share always is: it is a state of the
/// pipeline). Refused: a video that cannot be read, a damaged frame, layers of different sizes.
///
/// `paper` holds the figures as the published method's tables define them (Bundled Camera Paths,
/// Liu et al. 2013, for one view; Guo et al. 2016 for a seam), to stand beside those tables:
///   cropping            mean over frames of the whole picture's `cropping` (see ViewMeter)
///   distortion          smallest `distortion_eigen` of the whole picture, of all frames
///   stability           energy share of the 2nd to 6th lowest frequency of the output's whole
///   path,
///                       mean of translation and rotation; `stability` is their smaller one
///   stitching_score_px  largest of the frames' mean distances
/// What to know when comparing figures with those of other programs:
/// - A trend or a pan fills the lowest frequencies, so that stability is near 1 for any long pan;
///   `stability_detrended` and `jitter_ratio` are not fooled. Stability depends on the number of
///   frames: the same shake in a recording twice as long counts less.
/// - Some programs divide the scale by the size ratio of output to input, and so call no cropping
///   what lies on a large canvas; here a larger canvas is no crop and hides none.
/// - The worst frame's distortion depends on the inlier threshold as long as there is parallax
///   (see ViewMeter), and on how many frames are matched: so does the stitching score, which is one
///   frame's too. Figures with different `step` are not comparable.
/// - Jerk is in pixels of the video at hand; programs that scale paths to one width give others.
hal::Checked<Quality> Evaluate(const EvaluationOptions& options);

}  // namespace hitchview::app
