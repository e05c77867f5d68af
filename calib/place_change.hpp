#pragma once

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Geometry>
#include <array>

#include "calib/reprojection_error.hpp"

/// Places as the adjustment of many of them changes them: small turns and shifts from a start, so
/// that no rotation vector comes near its singular length.
namespace hitchview::calib {

/// Turn in the moved frame's own axes, rad, then shift in the outer frame, m: R = R0 Exp(turn),
/// t = t0 + shift.
using PlaceChange = std::array<double, 6>;

inline Eigen::Isometry3d Changed(const Eigen::Isometry3d& start, const PlaceChange& change) {
    Eigen::Isometry3d place = start;
    place.linear() = start.linear() * Rotation({change[0], change[1], change[2]});
    place.translation() += Eigen::Vector3d(change[3], change[4], change[5]);
    return place;
}

/// T_outer_moved * p.
template <typename T>
Eigen::Matrix<T, 3, 1> FromMoved(const Eigen::Isometry3d& start, const T* change,
                                 const Eigen::Matrix<T, 3, 1>& p) {
    Eigen::Matrix<T, 3, 1> turned;
    ceres::AngleAxisRotatePoint(change, p.data(), turned.data());
    return start.linear().cast<T>() * turned + start.translation().cast<T>() +
           Eigen::Map<const Eigen::Matrix<T, 3, 1>>(change + 3);
}

/// T_outer_moved^-1 * p.
template <typename T>
Eigen::Matrix<T, 3, 1> IntoMoved(const Eigen::Isometry3d& start, const T* change,
                                 const Eigen::Matrix<T, 3, 1>& p) {
    const Eigen::Matrix<T, 3, 1> shifted =
        p - start.translation().cast<T>() - Eigen::Map<const Eigen::Matrix<T, 3, 1>>(change + 3);
    const Eigen::Matrix<T, 3, 1> q = start.linear().transpose().cast<T>() * shifted;
    const T back[3] = {-change[0], -change[1], -change[2]};
    Eigen::Matrix<T, 3, 1> turned;
    ceres::AngleAxisRotatePoint(back, q.data(), turned.data());
    return turned;
}

/// Where a known lens shows a point of its camera's frame.
template <typename T>
Eigen::Matrix<T, 2, 1> ImagePoint(const LensParameters& lens,
                                  const Eigen::Matrix<T, 3, 1>& p_camera) {
    T focal_and_centre[4];
    T distortion[5];
    for (std::size_t i = 0; i < 4; ++i) focal_and_centre[i] = T(lens.focal_and_centre.at(i));
    for (std::size_t i = 0; i < 5; ++i) distortion[i] = T(lens.distortion.at(i));
    return ImagePoint(lens.kind, focal_and_centre, distortion, p_camera.data());
}

}  // namespace hitchview::calib
