#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "calib/camera_graph.hpp"
#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// Everything that is solved for.
struct UnitPlaces {
    std::vector<Eigen::Isometry3d> T_unit_camera{};
    std::vector<Eigen::Isometry3d> T_unit_target{};  ///< of each node of the graph
    /// Of each target: printed size over the one that was said.
    std::vector<double> size{};
};

/// Which corners of which sightings count.
using KeptCorners = std::vector<std::vector<bool>>;

/// All corners of the sightings that are part of the graph.
KeptCorners AllCorners(const UnitProblem& problem, const CameraGraph& graph);

struct UnitAdjustmentOptions {
    double sigma_px = 0.3;                   ///< standard deviation of a corner's coordinate
    bool robust = false;                     ///< large errors count less
    std::optional<std::size_t> free_size{};  ///< target whose printed size is solved for
    /// The only place that may change: a camera, or after the cameras a node of the graph.
    std::optional<std::size_t> only{};
};

/// How well the places are determined. Unknowns: six for each camera and node (see PlaceChange),
/// then the size of the free target.
struct UnitInformation {
    Eigen::MatrixXd covariance{};  ///< for errors of the sizes that were assumed
    /// What one more Gauss-Newton step would change; matches in the open are not looked at.
    Eigen::VectorXd step{};
    double pixel_scale = 1;  ///< errors of corners over those that were assumed
    double prior_scale = 1;  ///< same of surveyed corners and measured poses; 1: too few to tell
};

/// Bundle adjustment of one unit (Triggs et al., "Bundle Adjustment: A Modern Synthesis", 2000):
/// corners, surveyed corners, measured poses and far matches together, lenses as they are.
class UnitAdjustment {
 public:
    /// Borrows everything.
    UnitAdjustment(const UnitProblem& problem, const CameraGraph& graph, const KeptCorners& kept,
                   const UnitAdjustmentOptions& options, UnitPlaces& places);
    ~UnitAdjustment();

    /// Changes the places; false if the solver failed.
    bool Solve();
    /// Half the sum of squared errors, with robust loss where it was asked for; after Solve.
    [[nodiscard]] double cost() const;
    /// Around the places of the last Solve, or of construction. Empty where the sightings do not
    /// determine every place.
    std::optional<UnitInformation> Information();

 private:
    struct Blocks;
    std::unique_ptr<Blocks> blocks_;
    UnitPlaces& places_;
};

}  // namespace hitchview::calib
