#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>

#include "tests/support/sine_texture.hpp"

namespace hitchview::tests {

/// A world whose every distance is known: level ground, a wall on either side of the road and a
/// board before each, painted with waves. World frame: x forward, y left, z up, m.
class WalledRoad {
 public:
    static constexpr double kGround_m = -0.4;
    static constexpr double kWall_m = 7;  ///< left and right of the middle
    static constexpr double kBoard_m = 5;
    static constexpr double kBoardFirst_m = -0.5;  ///< forward
    static constexpr double kBoardLast_m = 0.7;

    /// First point on the ray from `origin_m`; empty where it meets the sky.
    [[nodiscard]] static std::optional<Eigen::Vector3d> Hit(const Eigen::Vector3d& origin_m,
                                                            const Eigen::Vector3d& direction) {
        constexpr double kTop_m = 6;
        double nearest = std::numeric_limits<double>::infinity();
        const auto take = [&](double s) {
            if (s > 1e-6 && s < nearest) nearest = s;
        };
        take((kGround_m - origin_m.z()) / direction.z());
        for (const double side : {1.0, -1.0}) {
            take((side * kWall_m - origin_m.y()) / direction.y());
            take(ToBoard(origin_m, direction, side * kBoard_m));
        }
        if (std::isinf(nearest)) return std::nullopt;
        const Eigen::Vector3d hit_m = origin_m + nearest * direction;
        if (hit_m.z() > kTop_m) return std::nullopt;
        return hit_m;
    }

    /// Grey of a point of a surface.
    [[nodiscard]] double Grey(const Eigen::Vector3d& p_m) const {
        constexpr double kUnits_per_m = 40;
        const Eigen::Vector3d p = kUnits_per_m * p_m;
        if (p_m.z() < kGround_m + 1e-6) return ground_.At(p.x(), p.y());
        if (std::abs(p_m.y()) > kWall_m - 1e-6) return wall_.At(p.x(), p.z());
        return board_.At(p.x(), p.z());
    }

 private:
    /// Where a ray meets the board at y_m, in lengths of `direction`.
    static double ToBoard(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction,
                          double y_m) {
        const double s = (y_m - origin_m.y()) / direction.y();
        const double x_m = origin_m.x() + s * direction.x();
        return x_m < kBoardFirst_m || x_m > kBoardLast_m ? -1 : s;
    }

    SineTexture ground_{11, 5, 100};
    SineTexture wall_{12, 5, 100};
    SineTexture board_{13, 5, 100};
};

}  // namespace hitchview::tests
