#pragma once

#include <Eigen/Core>

#include "algo/fixed_vector.hpp"

namespace hitchview::algo {

/// One feature seen in two neighbouring frames of the same view; pixels of the view.
struct FeatureMotion {
    Eigen::Vector2d early_px;
    Eigen::Vector2d late_px;
};

inline constexpr std::size_t kMaxFeatures = 512;
/// Intra motion of one view.
using FeatureMotions = FixedVector<FeatureMotion, kMaxFeatures>;

/// One scene point seen by both units at the same time; pixels of the two views.
struct InterFeature {
    Eigen::Vector2d tractor_px;
    Eigen::Vector2d trailer_px;
};

inline constexpr std::size_t kMaxInterFeatures = 384;
/// Inter motion of one overlap.
using InterFeatures = FixedVector<InterFeature, kMaxInterFeatures>;

}  // namespace hitchview::algo
