#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "algo/camera_model.hpp"
#include "calib/board.hpp"

namespace hitchview::calib {

/// Pictures of one board by one lens. A view has at least six corners, not all in one line.
struct LensProblem {
    algo::CameraModel::Kind kind = algo::CameraModel::Kind::kKannalaBrandt4;
    int width_px = 0;
    int height_px = 0;
    Board board;
    std::vector<SeenCorners> views;
};

/// Focal lengths, centre, and distortion in the order of CameraModel.
inline constexpr int kMaxLensParameters = 9;
using LensCovariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxLensParameters,
                                     kMaxLensParameters>;

/// Lens, shape of the board and place of the board in each view that explain the corners best.
struct LensSolution {
    algo::CameraModel model{};
    std::vector<Eigen::Vector3d> board_m{};           ///< corners, board frame
    std::vector<Eigen::Isometry3d> T_camera_board{};  ///< of each view
    std::vector<double> view_rms_px{};                ///< of each view
    double rms_px = 0;                                ///< root of the mean squared distance
    /// Of the parameters, for independent errors of the size that is left; empty where the views do
    /// not determine them, or it was not asked for.
    std::optional<LensCovariance> covariance{};
};

enum class BoardShape {
    kFlat,  ///< as it was meant to be printed
    /// Every corner where the pictures show it: paper bulges, and glue draws it. A bundle
    /// adjustment over the target as well; see Strobl and Hirzinger, "More accurate pinhole camera
    /// calibration with imperfect planar target", ICCV Workshops 2011.
    kMeasured,
};

struct LensSolverOptions {
    BoardShape shape = BoardShape::kFlat;
    bool robust = false;      ///< large errors count less
    bool covariance = false;  ///< takes time
};

/// Least squares over everything, from a start that it finds by itself. Empty: the views determine
/// no lens. Thread-safe, and its result does not depend on the machine's load.
std::optional<LensSolution> SolveLens(const LensProblem& problem, const LensSolverOptions& options);

/// The same from a solution for other views of the same lens and board.
std::optional<LensSolution> SolveLensFrom(const LensSolution& start, const LensProblem& problem,
                                          const LensSolverOptions& options);

/// Corners in all views.
[[nodiscard]] std::size_t CornerCount(const std::vector<SeenCorners>& views);

/// Place of a board that a roughly known lens sees, from a homography: without regard to the
/// board's shape. Empty: too far from the axis, or degenerate.
std::optional<Eigen::Isometry3d> RoughPlace(const algo::CameraModel& model,
                                            std::span<const Eigen::Vector3d> board_m,
                                            const SeenCorners& corners);

/// Place of a board that a known lens sees. Empty: too far from the axis, or degenerate.
std::optional<Eigen::Isometry3d> SolvePlace(const algo::CameraModel& model,
                                            std::span<const Eigen::Vector3d> board_m,
                                            const SeenCorners& corners);

/// Sum of the squared distances between the corners and where the model shows the board's, px^2.
double SquaredErrors(const algo::CameraModel& model, std::span<const Eigen::Vector3d> board_m,
                     const Eigen::Isometry3d& T_camera_board, const SeenCorners& corners);

}  // namespace hitchview::calib
