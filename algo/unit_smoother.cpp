#include "algo/unit_smoother.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {

using Eigen::Vector3d;

WalledPaperWeights::WalledPaperWeights(const PathSmootherOptions& options,
                                       const ProfileSmoothingOptions& weights)
    : options_(options),
      smoother_(weights, options.lookahead_frames),
      history_(weights.radius_frames) {}

Vector3d WalledPaperWeights::Next(const PathSmoother::Window& window) {
    // The newest output is known exactly. The older ones lie near it, turned nearly alike, so that
    // the path has moved them as it has moved the newest.
    if (history_.outputs().empty())
        history_.Push(window.early_output);
    else
        history_.Move(emitted_ - window.early_output);
    const std::span ahead(window.ahead.data(), static_cast<std::size_t>(options_.lookahead_frames));
    emitted_ = Cut(smoother_.Next({history_.outputs(), ahead}));
    history_.Push(emitted_);
    return emitted_;
}

/// The turn takes its share of the shift's room, as in PathSmoother.
Vector3d WalledPaperWeights::Cut(const Vector3d& offset) const {
    Vector3d cut = offset.cwiseMin(options_.wall).cwiseMax(-options_.wall);
    for (const int axis : {0, 1}) {
        const double taken_px = options_.turn_takes_px(axis) * std::abs(cut(2));
        const double room_px = std::max(0.0, options_.wall(axis) - taken_px);
        cut(axis) = std::clamp(cut(axis), -room_px, room_px);
    }
    return cut;
}

}  // namespace hitchview::algo
