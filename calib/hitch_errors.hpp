#pragma once

#include "calib/place_change.hpp"

/// What the search for the hitch point makes small; each error is divided by its standard
/// deviation.
namespace hitchview::calib {

/// A corner that a camera of the tractor sees. Changes of T_world_tractor and T_world_target.
struct TractorCornerError {
    template <typename T>
    bool operator()(const T* tractor, const T* target, T* error) const {
        const Eigen::Matrix<T, 3, 1> p_world =
            FromMoved(T_world_target, target, Eigen::Matrix<T, 3, 1>(corner_m.cast<T>()));
        return Compare(IntoMoved(T_world_tractor, tractor, p_world), error);
    }

    /// Of a point in the frame of the camera's unit.
    template <typename T>
    bool Compare(const Eigen::Matrix<T, 3, 1>& p_unit, T* error) const {
        const Eigen::Matrix<T, 3, 1> p_camera =
            T_camera_unit.linear().cast<T>() * p_unit + T_camera_unit.translation().cast<T>();
        Eigen::Map<Eigen::Matrix<T, 2, 1>> difference(error);
        difference = (ImagePoint(lens, p_camera) - at_px.cast<T>()) / T(sigma_px);
        return true;
    }

    const LensParameters& lens;
    Eigen::Isometry3d T_camera_unit;
    Eigen::Isometry3d T_world_tractor;
    Eigen::Isometry3d T_world_target;
    Eigen::Vector3d corner_m;
    Eigen::Vector2d at_px;
    double sigma_px;
};

/// The same of the trailer: p_tractor = hitch_tractor + R (p_trailer - hitch_trailer), where R is
/// `R_tractor_trailer` turned by `turn`; `hitch`: the point in both frames.
struct TrailerCornerError {
    template <typename T>
    bool operator()(const T* tractor, const T* turn, const T* hitch, const T* target,
                    T* error) const {
        const Eigen::Matrix<T, 3, 1> p_world =
            FromMoved(seen.T_world_target, target, Eigen::Matrix<T, 3, 1>(seen.corner_m.cast<T>()));
        const Eigen::Matrix<T, 3, 1> p_tractor = IntoMoved(seen.T_world_tractor, tractor, p_world);
        const Eigen::Matrix<T, 3, 1> arm =
            R_tractor_trailer.transpose().cast<T>() *
            (p_tractor - Eigen::Map<const Eigen::Matrix<T, 3, 1>>(hitch));
        const T back[3] = {-turn[0], -turn[1], -turn[2]};
        Eigen::Matrix<T, 3, 1> p_trailer;
        ceres::AngleAxisRotatePoint(back, arm.data(), p_trailer.data());
        p_trailer += Eigen::Map<const Eigen::Matrix<T, 3, 1>>(hitch + 3);
        return seen.Compare(p_trailer, error);
    }

    TractorCornerError seen;
    Eigen::Matrix3d R_tractor_trailer;
};

/// The trailer's z axis hardly leans against the tractor's.
struct LeanError {
    template <typename T>
    bool operator()(const T* turn, T* error) const {
        for (int axis = 0; axis < 2; ++axis) {
            const Eigen::Matrix<T, 3, 1> along = Eigen::Vector3d::Unit(axis).cast<T>();
            Eigen::Matrix<T, 3, 1> turned;
            ceres::AngleAxisRotatePoint(turn, along.data(), turned.data());
            error[axis] = R_tractor_trailer.row(2).cast<T>().dot(turned.transpose()) / T(sigma_rad);
        }
        return true;
    }

    Eigen::Matrix3d R_tractor_trailer;
    double sigma_rad;
};

/// The hitch point is at some height in the tractor's frame.
struct HeightError {
    template <typename T>
    bool operator()(const T* hitch, T* error) const {
        error[0] = (hitch[2] - height_m) / T(sigma_m);
        return true;
    }

    double height_m;
    double sigma_m;
};

}  // namespace hitchview::calib
