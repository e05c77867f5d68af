#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib/lens_solver.hpp"
#include "calib/projection_uncertainty.hpp"
#include "calib/verdict.hpp"

namespace hitchview::calib {

/// Pictures of one board by one lens.
struct LensPictures {
    algo::CameraModel::Kind kind = algo::CameraModel::Kind::kKannalaBrandt4;
    int width_px = 0;
    int height_px = 0;
    Board board{};
    std::vector<BoardView> views{};
};

/// What became of one picture.
struct ViewOutcome {
    enum class Fate {
        kUsed,
        kFewCorners,  ///< of the board is too little in it
        kSmeared,     ///< the board or the camera moved, or it is out of focus
        kOutlier,     ///< far worse than the others
    };
    std::string name{};
    Fate fate = Fate::kUsed;
    double rms_px = 0;                ///< of a used one
    std::optional<double> blur_px{};  ///< see BoardBlur_px

    [[nodiscard]] bool is_used() const { return fate == Fate::kUsed; }
};

/// Where a corner of a used view was seen, and how far from there lens and board put it.
struct CornerResidual {
    int view = 0;  ///< index in Intrinsics::views
    Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
    Eigen::Vector2d off_px = Eigen::Vector2d::Zero();  ///< seen minus expected
};

/// How well the views cover what a lens can do.
struct ViewSpread {
    static constexpr int kColumns = 8;
    static constexpr int kRows = 5;

    std::array<std::array<int, kColumns>, kRows> corners{};  ///< in each cell of the picture
    double covered = 0;                                      ///< share of cells with one. [0, 1]
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
    std::vector<CornerResidual> residuals{};
    ViewSpread spread{};
    std::vector<double> sigma{};  ///< of fx, fy, cx, cy and the distortion; empty if not determined
    std::vector<PixelUncertainty> uncertainty{};
    Verdict verdict = Verdict::kFail;
    std::vector<std::string> reasons{};  ///< why not kPass, for a person: what to do
};

/// Measures a lens: turns the views alike, leaves smeared ones and outliers out, finds by
/// cross-validation whether the board is flat, solves, and judges. Empty: no lens explains the
/// views.
std::optional<Intrinsics> MeasureIntrinsics(const LensPictures& pictures);

/// Whether it may be driven with, and if not, what to do about it.
void JudgeIntrinsics(Intrinsics& intrinsics);

/// What it is judged by, for a file: "rms 1 px, ...".
std::string IntrinsicsLimits();

}  // namespace hitchview::calib
