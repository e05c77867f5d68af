#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "calib/hitch_start.hpp"

namespace hitchview::calib {

/// Where the places put what cameras see.
class HitchPredictor {
 public:
    /// Borrows both.
    HitchPredictor(const HitchProblem& problem, const HitchPlaces& places)
        : problem_(problem), places_(places) {}

    /// Shot of a sighting that can be used.
    [[nodiscard]] std::optional<std::size_t> ShotOf(const Sighting& sighting) const;
    /// Distances of its corners from where they should be, px; infinite where that is nowhere.
    [[nodiscard]] std::vector<double> Errors(const Sighting& sighting) const;

 private:
    [[nodiscard]] Eigen::Isometry3d T_world_unit(std::size_t shot, algo::Unit unit) const;

    const HitchProblem& problem_;
    const HitchPlaces& places_;
};

/// How well the places are determined. Unknowns: the hitch point in both frames, then the turn of
/// the trailer in each shot about its own axes, then other things.
struct HitchInformation {
    Eigen::MatrixXd covariance{};
    double pixel_scale = 1;  ///< errors of corners over those that were assumed
    bool height_is_measured = false;
};

/// Corners that count, of each sighting.
using KeptHitchCorners = std::vector<std::vector<bool>>;

/// One joint adjustment of tractor, articulations, hitch point and targets.
class HitchAdjustment {
 public:
    /// Borrows everything. `sigma_px`: standard deviation of a corner's coordinate.
    HitchAdjustment(const HitchProblem& problem, const KeptHitchCorners& kept, double sigma_px,
                    bool robust, HitchPlaces& places);
    ~HitchAdjustment();

    /// Changes the places; false if the solver failed.
    bool Solve();
    /// Empty where the pictures do not determine everything.
    std::optional<HitchInformation> Information();

 private:
    struct Blocks;
    std::unique_ptr<Blocks> blocks_;
};

}  // namespace hitchview::calib
