#include "drivers/simulated_outlook.hpp"

#include <numeric>

namespace hitchview::drivers {
namespace {

using Eigen::Vector3d;

constexpr double kSurfaceTolerance = 1e-3;  // of the distance: rays are cast in single precision

}  // namespace

Outlook::Outlook(const World& world, const Vector3d& eye_world, const Moment& moment) {
    world.Look(eye_world, moment, 0, around_);
    all_.resize(around_.solids.size());
    std::iota(all_.begin(), all_.end(), 0U);
}

double Outlook::DistanceTo(const Vector3d& direction) const {
    return World::Cast(around_, all_, direction.cast<float>()).distance_m;
}

bool Outlook::IsFreeTo(const Vector3d& p_world_m) const {
    const Vector3d to_point = p_world_m - around_.eye_world;
    return DistanceTo(to_point.normalized()) >= to_point.norm() * (1 - kSurfaceTolerance);
}

}  // namespace hitchview::drivers
