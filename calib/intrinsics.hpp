#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/lens_solver.hpp"
#include "calib/projection_uncertainty.hpp"
#include "calib/verdict.hpp"

namespace hitchview::calib {

/// What became of one picture.
struct ViewOutcome {
    std::string name{};
    bool used = false;
    double rms_px = 0;  ///< of a used one
};

/// How well the views cover what a lens can do.
struct ViewSpread {
    double covered = 0;        ///< share of the picture's 8 x 5 cells with a corner. [0, 1]
    double most_tilt_rad = 0;  ///< of a board's normal against the ray to its middle
    double nearest = 0;        ///< board's width over its distance, largest and smallest
    double farthest = 0;
};

/// A lens as it was measured, with what is to be thought of it.
struct Intrinsics {
    algo::CameraModel model;
    BoardShape shape = BoardShape::kFlat;
    std::vector<Eigen::Vector3d> board_m{};
    double bulge_m = 0;  ///< farthest corner from where it should have been printed; 0 if flat
    double rms_px = 0;   ///< over the used views
    std::optional<double> heldout_rms_px{};
    std::vector<ViewOutcome> views{};
    ViewSpread spread{};
    std::vector<double> sigma{};  ///< of fx, fy, cx, cy and the distortion; empty if not determined
    std::vector<PixelUncertainty> uncertainty{};
    Verdict verdict = Verdict::kFail;
    std::vector<std::string> reasons{};  ///< why not kPass, for a person: what to do
};

/// Measures a lens: turns the views alike, leaves outliers out, finds by cross-validation whether
/// the board is flat, solves, and judges. Empty: no lens explains the views.
std::optional<Intrinsics> MeasureIntrinsics(const LensProblem& problem,
                                            const std::vector<std::string>& names);

/// Whether it may be driven with, and if not, what to do about it.
void JudgeIntrinsics(Intrinsics& intrinsics);

}  // namespace hitchview::calib
