#pragma once

#include <Eigen/Core>

namespace hitchview::algo {

// The formulas of CameraModel for any kind of number, so that calibration differentiates what the
// road code computes.

/// Distance theta' from the image centre of a ray `theta` off the axis; `k`: k1 k2 k3 k4.
template <typename T>
T FisheyeRadius(const T* k, const T& theta) {
    const T t2 = theta * theta;
    return theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

/// (a', b') of the ray (a, b, 1); `k`: k1 k2 p1 p2 k3.
template <typename T>
Eigen::Matrix<T, 2, 1> RadtanPoint(const T* k, const T& a, const T& b) {
    const T r2 = a * a + b * b;
    const T d = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    return {a * d + 2.0 * k[2] * a * b + k[3] * (r2 + 2.0 * a * a),
            b * d + k[2] * (r2 + 2.0 * b * b) + 2.0 * k[3] * a * b};
}

}  // namespace hitchview::algo
