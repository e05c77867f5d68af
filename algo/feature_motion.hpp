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

inline constexpr std::size_t kMaxInterFeatures = 768;
/// Inter motion of one overlap.
using InterFeatures = FixedVector<InterFeature, kMaxInterFeatures>;

/// The same of the dense parallax; `weight` 0..1: how well it is known.
struct ParallaxSample {
    InterFeature pair;
    float weight;
};
inline constexpr std::size_t kMaxParallaxSamples = 16384;
using ParallaxSamples = FixedVector<ParallaxSample, kMaxParallaxSamples>;

}  // namespace hitchview::algo
