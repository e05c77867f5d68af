#pragma once

#include <numbers>

#include "calib/place_change.hpp"
#include "calib/unit_problem.hpp"

/// What the adjustment of a unit makes small; each error is divided by its standard deviation.
namespace hitchview::calib {

/// Of one corner in one picture. Changes of T_unit_camera and T_unit_target, and the printed size
/// of the board over the one that was said.
struct SightedCornerError {
    template <typename T>
    bool operator()(const T* camera, const T* target, const T* size, T* error) const {
        const Eigen::Matrix<T, 3, 1> p_board = corner_m.cast<T>() * size[0];
        const Eigen::Matrix<T, 3, 1> p_unit = FromMoved(T_unit_target, target, p_board);
        Eigen::Map<Eigen::Matrix<T, 2, 1>> difference(error);
        difference =
            (ImagePoint(lens, IntoMoved(T_unit_camera, camera, p_unit)) - at_px.cast<T>()) /
            T(sigma_px);
        return true;
    }

    const LensParameters& lens;
    Eigen::Isometry3d T_unit_camera;
    Eigen::Isometry3d T_unit_target;
    Eigen::Vector3d corner_m;
    Eigen::Vector2d at_px;
    double sigma_px;
};

/// Of one surveyed corner.
struct SurveyError {
    template <typename T>
    bool operator()(const T* target, const T* size, T* error) const {
        const Eigen::Matrix<T, 3, 1> p_board = corner.p_board_m.cast<T>() * size[0];
        Eigen::Map<Eigen::Matrix<T, 3, 1>> difference(error);
        difference =
            (FromMoved(T_unit_target, target, p_board) - corner.p_unit_m.cast<T>()) / T(sigma_m);
        return true;
    }

    Eigen::Isometry3d T_unit_target;
    SurveyedCorner corner;
    double sigma_m;
};

/// Of one measured pose.
struct PoseError {
    template <typename T>
    bool operator()(const T* camera, T* error) const {
        const Eigen::Quaterniond start(measured.T_unit_camera.linear().transpose() *
                                       T_unit_camera.linear());
        const T q_measured_start[4] = {T(start.w()), T(start.x()), T(start.y()), T(start.z())};
        T q_start_camera[4];
        T q_measured_camera[4];
        ceres::AngleAxisToQuaternion(camera, q_start_camera);
        ceres::QuaternionProduct(q_measured_start, q_start_camera, q_measured_camera);
        ceres::QuaternionToAngleAxis(q_measured_camera, error);
        for (int i = 0; i < 3; ++i) {
            error[i] /= T(measured.sigma_rad);
            error[3 + i] = (camera[3 + i] + T_unit_camera.translation()[i] -
                            measured.T_unit_camera.translation()[i]) /
                           T(measured.sigma_m);
        }
        return true;
    }

    Eigen::Isometry3d T_unit_camera;
    MeasuredPose measured;
};

/// Of something far away that two cameras see. Changes of both, and the inverse of its distance
/// from the first.
struct FarMatchError {
    template <typename T>
    bool operator()(const T* first, const T* second, const T* inverse_m, T* error) const {
        // Everything times the inverse distance: nothing is infinite.
        const Eigen::Matrix<T, 3, 1> turned =
            FromMoved(T_unit_first, first, Eigen::Matrix<T, 3, 1>(direction.cast<T>()));
        const Eigen::Matrix<T, 3, 1> from = T_unit_first.translation().cast<T>() +
                                            Eigen::Map<const Eigen::Matrix<T, 3, 1>>(first + 3);
        const Eigen::Matrix<T, 3, 1> to = T_unit_second.translation().cast<T>() +
                                          Eigen::Map<const Eigen::Matrix<T, 3, 1>>(second + 3);
        const Eigen::Matrix<T, 3, 1> ray = turned - from + (from - to) * inverse_m[0];
        Eigen::Map<Eigen::Matrix<T, 2, 1>> difference(error);
        difference =
            (ImagePoint(lens, IntoMoved(T_unit_second, second, Eigen::Matrix<T, 3, 1>(ray + to))) -
             at_px.cast<T>()) /
            T(sigma_px);
        return true;
    }

    const LensParameters& lens;  ///< of the second camera
    Eigen::Isometry3d T_unit_first;
    Eigen::Isometry3d T_unit_second;
    Eigen::Vector3d direction;  ///< in the first camera's frame
    Eigen::Vector2d at_px;      ///< in the second camera's picture
    double sigma_px;
};

/// Of a match that is farther away than parallax can be seen; to be used with a loss that forgets
/// it where it is not.
struct AtInfinityError {
    template <typename T>
    bool operator()(const T* inverse_m, T* error) const {
        error[0] = inverse_m[0] / T(sigma_per_m);
        return true;
    }

    double sigma_per_m;
};

}  // namespace hitchview::calib
