#pragma once

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "algo/camera_model.hpp"
#include "algo/camera_projection.hpp"

/// What the calibration makes small: distances between corners seen and corners expected.
namespace hitchview::calib {

/// Rotation vector and translation of T_camera_board.
using PlaceParameters = std::array<double, 6>;

inline Eigen::Matrix3d Rotation(const Eigen::Vector3d& axis) {
    const double angle = axis.norm();
    if (angle < 1e-12) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, axis / angle).toRotationMatrix();
}

inline PlaceParameters Parameters(const Eigen::Isometry3d& T_camera_board) {
    const Eigen::AngleAxisd turn(T_camera_board.linear());
    const Eigen::Vector3d axis = turn.angle() * turn.axis();
    const Eigen::Vector3d& t = T_camera_board.translation();
    return {axis.x(), axis.y(), axis.z(), t.x(), t.y(), t.z()};
}

inline Eigen::Isometry3d Place(const PlaceParameters& p) {
    Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
    T_camera_board.linear() = Rotation({p[0], p[1], p[2]});
    T_camera_board.translation() = Eigen::Vector3d(p[3], p[4], p[5]);
    return T_camera_board;
}

/// A lens in the form that the solver changes.
struct LensParameters {
    explicit LensParameters(const algo::CameraModel& model)
        : kind(model.kind),
          focal_and_centre{model.fx_px, model.fy_px, model.cx_px, model.cy_px},
          distortion(model.distortion) {}

    void CopyTo(algo::CameraModel& model) const {
        model.fx_px = focal_and_centre[0];
        model.fy_px = focal_and_centre[1];
        model.cx_px = focal_and_centre[2];
        model.cy_px = focal_and_centre[3];
        model.distortion = distortion;
    }

    algo::CameraModel::Kind kind;
    std::array<double, 4> focal_and_centre;
    std::array<double, 5> distortion;  ///< four used by kKannalaBrandt4
};

/// Where a lens shows a point of the camera frame: CameraModel::Project for any kind of number.
template <typename T>
Eigen::Matrix<T, 2, 1> ImagePoint(algo::CameraModel::Kind kind, const T* focal_and_centre,
                                  const T* distortion, const T* p_camera) {
    Eigen::Matrix<T, 2, 1> at;
    if (kind == algo::CameraModel::Kind::kPinholeRadtan) {
        at = algo::RadtanPoint(distortion, p_camera[0] / p_camera[2], p_camera[1] / p_camera[2]);
    } else {
        // Never exactly on the axis, where the direction has no derivative.
        const T across = sqrt(p_camera[0] * p_camera[0] + p_camera[1] * p_camera[1] + 1e-18);
        const T share = algo::FisheyeRadius(distortion, atan2(across, p_camera[2])) / across;
        at = {p_camera[0] * share, p_camera[1] * share};
    }
    return {focal_and_centre[0] * at[0] + focal_and_centre[2],
            focal_and_centre[1] * at[1] + focal_and_centre[3]};
}

/// Of one corner in one view; everything may change.
struct CornerError {
    template <typename T>
    bool operator()(const T* focal_and_centre, const T* distortion, const T* place,
                    const T* corner_m, T* error) const {
        T p_camera[3];
        ceres::AngleAxisRotatePoint(place, corner_m, p_camera);
        for (int i = 0; i < 3; ++i) p_camera[i] += place[3 + i];
        Eigen::Map<Eigen::Matrix<T, 2, 1>> difference(error);
        difference = ImagePoint(kind, focal_and_centre, distortion, p_camera) - seen.cast<T>();
        return true;
    }

    template <int kDistortion>
    static ceres::CostFunction* Create(algo::CameraModel::Kind kind, const Eigen::Vector2d& seen) {
        return new ceres::AutoDiffCostFunction<CornerError, 2, 4, kDistortion, 6, 3>(
            new CornerError{kind, seen});
    }

    algo::CameraModel::Kind kind;
    Eigen::Vector2d seen;
};

/// Of one corner of a known board through a known lens; its place may change.
struct PlaceError {
    template <typename T>
    bool operator()(const T* place, T* error) const {
        T focal_and_centre[4];
        T distortion[5];
        T corner[3];
        for (int i = 0; i < 4; ++i) focal_and_centre[i] = T(lens.focal_and_centre.at(i));
        for (int i = 0; i < 5; ++i) distortion[i] = T(lens.distortion.at(i));
        for (int i = 0; i < 3; ++i) corner[i] = T(corner_m[i]);
        return CornerError{lens.kind, seen}(focal_and_centre, distortion, place, corner, error);
    }

    static ceres::CostFunction* Create(const LensParameters& lens, const Eigen::Vector3d& corner_m,
                                       const Eigen::Vector2d& seen) {
        return new ceres::AutoDiffCostFunction<PlaceError, 2, 6>(
            new PlaceError{lens, corner_m, seen});
    }

    LensParameters lens;
    Eigen::Vector3d corner_m;
    Eigen::Vector2d seen;
};

/// Of one corner of the board itself: as far from where it should have been printed as paper goes
/// counts like one pixel.
struct ShapeError {
    template <typename T>
    bool operator()(const T* corner_m, T* error) const {
        for (int i = 0; i < 3; ++i) error[i] = (corner_m[i] - printed_m[i]) / tolerance_m;
        return true;
    }

    static ceres::CostFunction* Create(const Eigen::Vector3d& printed_m, double tolerance_m) {
        return new ceres::AutoDiffCostFunction<ShapeError, 3, 3>(
            new ShapeError{printed_m, tolerance_m});
    }

    Eigen::Vector3d printed_m;
    double tolerance_m;
};

inline ceres::Solver::Options SolverSettings() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-10;
    options.parameter_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    return options;
}

}  // namespace hitchview::calib
