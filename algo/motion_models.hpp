#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace hitchview::algo {

/// The same scene point seen twice: as rays of two pictures (see Projection).
struct RayPair {
    Eigen::Vector3d from;
    Eigen::Vector3d to;
};

/// A motion model fits a 3x3 matrix M with to ~ M from to weighted pairs by least squares, and
/// measures how far a pair is from it. Fit is used on kMinimal pairs with unit weights as well; it
/// is empty when the pairs do not determine the model. SquaredResidual is in px^2: of the plane
/// (kPixelsPerRay = 1), or of the angle times `px_per_unit` on a ring.

/// Shift, turn and scale of the plane; 4 unknowns. Closed form (Umeyama, PAMI 1991).
struct SimilarityModel {
    static constexpr int kMinimal = 2;
    static std::optional<Eigen::Matrix3d> Fit(std::span<const RayPair> pairs,
                                              std::span<const double> weights);
    static double SquaredResidual(const Eigen::Matrix3d& m, const RayPair& pair,
                                  double px_per_unit);
};

/// Turn of all rays; 3 unknowns. Rays of unit length. Closed form (Kabsch; Umeyama, PAMI 1991).
struct RotationModel {
    static constexpr int kMinimal = 2;
    static std::optional<Eigen::Matrix3d> Fit(std::span<const RayPair> pairs,
                                              std::span<const double> weights);
    static double SquaredResidual(const Eigen::Matrix3d& m, const RayPair& pair,
                                  double px_per_unit);
};

/// Homography of the plane with M(2, 2) = 1; 8 unknowns. Normalised linear solution (Hartley,
/// PAMI 1997) of the equations to x (M from) = 0.
struct HomographyModel {
    static constexpr int kMinimal = 4;
    static std::optional<Eigen::Matrix3d> Fit(std::span<const RayPair> pairs,
                                              std::span<const double> weights);
    static double SquaredResidual(const Eigen::Matrix3d& m, const RayPair& pair,
                                  double px_per_unit);
};

}  // namespace hitchview::algo
