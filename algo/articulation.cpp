#include "algo/articulation.hpp"

#include <cmath>

namespace hitchview::algo {
namespace {

double Square(double x) {
    return x * x;
}

double YawOf(const Eigen::Matrix3d& R) {
    return std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
}

}  // namespace

ArticulationEstimator::ArticulationEstimator(const UnitGeometry& tractor,
                                             const UnitGeometry& trailer,
                                             const ArticulationOptions& options)
    : geometry_{{tractor, trailer}}, options_(options), hinge_(options.fit) {}

std::optional<Articulation> ArticulationEstimator::Step(
    const PerUnit<IntraMotion>& intra, const PerOverlap<InterFeatures>& inter_features) {
    Predict(intra);
    Gather(inter_features);
    const auto measured = Measure();
    const bool used = measured && Correct(*measured);
    if (!state_ || state_->variance > Square(options_.reported_sigma_rad)) return std::nullopt;
    return Articulation{state_->angle_rad, std::sqrt(state_->variance),
                        used ? measured->inliers : 0};
}

/// A view that turns to the right shows its unit turning to the left.
void ArticulationEstimator::Predict(const PerUnit<IntraMotion>& intra) {
    if (!state_) return;
    state_->angle_rad +=
        YawOf(intra[Unit::kTractor].M_late_early) - YawOf(intra[Unit::kTrailer].M_late_early);
    const bool known = intra[Unit::kTractor].known && intra[Unit::kTrailer].known;
    state_->variance += Square(known ? options_.prediction_rad : options_.blind_prediction_rad);
    if (state_->variance > Square(options_.lost_sigma_rad)) state_.reset();
}

void ArticulationEstimator::Gather(const PerOverlap<InterFeatures>& inter_features) {
    pairs_.clear();
    const auto sight = [&](Unit unit, const Eigen::Vector2d& pixel) {
        return geometry_[unit].SightAlong(geometry_[unit].view().Ray(pixel));
    };
    for (const Overlap overlap : kOverlaps) {
        for (const InterFeature& feature : inter_features[overlap]) {
            const auto tractor = sight(Unit::kTractor, feature.tractor_px);
            const auto trailer = sight(Unit::kTrailer, feature.trailer_px);
            if (tractor && trailer) pairs_.push_back({*tractor, *trailer});
        }
    }
}

std::optional<HingeFit> ArticulationEstimator::Measure() const {
    if (pairs_.count() < options_.min_inliers) return std::nullopt;
    const std::span<const SightPair> pairs(pairs_.data(), pairs_.size());
    const auto fit = state_ ? hinge_.Refine(pairs, state_->angle_rad) : hinge_.Search(pairs);
    const bool good = fit && fit->inliers >= options_.min_inliers &&
                      fit->inliers >= options_.min_share * pairs_.count() &&
                      fit->sigma_rad <= options_.measured_sigma_rad;
    return good ? fit : std::nullopt;
}

/// False if the measurement is too far off to be true. The filter is given up when it alone
/// disagrees: the next measurement is searched from nothing.
bool ArticulationEstimator::Correct(const HingeFit& measured) {
    const double variance = Square(measured.sigma_rad) + Square(options_.systematic_rad);
    if (!state_) {
        state_ = State{measured.yaw_rad, variance};
        return true;
    }
    const double innovation = measured.yaw_rad - state_->angle_rad;
    if (Square(innovation) > Square(options_.gate) * (state_->variance + variance)) {
        if (++state_->refused > options_.most_refused) state_.reset();
        return false;
    }
    const double gain = state_->variance / (state_->variance + variance);
    *state_ = {state_->angle_rad + gain * innovation, (1 - gain) * state_->variance};
    return true;
}

}  // namespace hitchview::algo
