#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "calib/lens_solver.hpp"
#include "calib/reprojection_error.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// The directions that the corners lie in; empty if the lens has none for one of them.
std::optional<std::vector<Vector3d>> Directions(const CameraModel& model,
                                                const SeenCorners& corners) {
    std::vector<Vector3d> directions;
    for (const SeenCorner& corner : corners) {
        const auto direction = model.Unproject(corner.at_px);
        if (!direction) return std::nullopt;
        directions.push_back(*direction);
    }
    return directions;
}

/// Corners as a pinhole camera sees them that was turned to look at their middle.
struct TurnedView {
    std::vector<cv::Point3d> board_m;
    std::vector<cv::Point2d> seen;
};

/// Without those at the edge of half a sphere and beyond, which no pinhole camera sees.
TurnedView Turned(const std::vector<Vector3d>& directions,
                  const Eigen::Quaterniond& q_turned_camera, std::span<const Vector3d> board_m,
                  const SeenCorners& corners) {
    constexpr double kLeastDepth = 0.1;
    TurnedView view;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vector3d turned = q_turned_camera * directions[i];
        if (turned.z() < kLeastDepth) continue;
        const Vector3d& at_m = board_m[static_cast<std::size_t>(corners[i].index)];
        view.board_m.emplace_back(at_m.x(), at_m.y(), 0);
        view.seen.emplace_back(turned.x() / turned.z(), turned.y() / turned.z());
    }
    return view;
}

}  // namespace

std::optional<Isometry3d> RoughPlace(const CameraModel& model, std::span<const Vector3d> board_m,
                                     const SeenCorners& corners) {
    const auto directions = Directions(model, corners);
    if (!directions) return std::nullopt;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& direction : *directions) middle += direction;
    const auto q_turned_camera = Eigen::Quaterniond::FromTwoVectors(middle, Vector3d::UnitZ());
    constexpr std::size_t kFewest = 4;
    const TurnedView view = Turned(*directions, q_turned_camera, board_m, corners);
    if (view.seen.size() < kFewest) return std::nullopt;
    cv::Vec3d rotation;
    cv::Vec3d translation;
    if (!cv::solvePnP(view.board_m, view.seen, cv::Matx33d::eye(), cv::noArray(), rotation,
                      translation, false, cv::SOLVEPNP_IPPE)) {
        return std::nullopt;
    }
    const Vector3d axis(rotation[0], rotation[1], rotation[2]);
    Isometry3d T_turned_board = Isometry3d::Identity();
    T_turned_board.linear() = Rotation(axis);
    T_turned_board.translation() = Vector3d(translation[0], translation[1], translation[2]);
    return q_turned_camera.inverse() * T_turned_board;
}

std::optional<Isometry3d> SolvePlace(const CameraModel& model, std::span<const Vector3d> board_m,
                                     const SeenCorners& corners) {
    const auto first = RoughPlace(model, board_m, corners);
    if (!first) return std::nullopt;
    PlaceParameters place = Parameters(*first);
    LensParameters lens(model);
    ceres::Problem problem;
    for (const SeenCorner& corner : corners) {
        const Vector3d& at_m = board_m[static_cast<std::size_t>(corner.index)];
        problem.AddResidualBlock(PlaceError::Create(lens, at_m, corner.at_px), nullptr,
                                 place.data());
    }
    ceres::Solver::Summary summary;
    ceres::Solve(SolverSettings(), &problem, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    return Place(place);
}

double SquaredErrors(const CameraModel& model, std::span<const Vector3d> board_m,
                     const Isometry3d& T_camera_board, const SeenCorners& corners) {
    CameraModel everywhere = model;
    everywhere.max_theta_rad = 3.14;
    double sum = 0;
    for (const SeenCorner& corner : corners) {
        const Vector3d& at_m = board_m[static_cast<std::size_t>(corner.index)];
        const auto expected = everywhere.Project(T_camera_board * at_m);
        if (!expected) return std::numeric_limits<double>::infinity();
        sum += (*expected - corner.at_px).squaredNorm();
    }
    return sum;
}

}  // namespace hitchview::calib
