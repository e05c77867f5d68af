#include "algo/unit_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

}  // namespace

double SideMargin(int width_px, int height_px, const Vector2d& pixel) {
    if (pixel.y() < 0 || pixel.y() > height_px - 1) return -1;
    return std::min(pixel.x(), width_px - 1 - pixel.x()) / width_px;
}

Vector3d AlignmentSurface::Hit(const Vector3d& ray) const {
    const Vector3d level = ray / ray.head<2>().norm();
    double distance = radius_m;
    if (level.z() < 0) distance = std::min(distance, (ground_m - viewpoint_m) / level.z());
    return Vector3d{0, 0, viewpoint_m} + distance * level;
}

Vector3d AlignmentSurface::RayOf(const Vector3d& position_m, const Vector3d& direction) const {
    // |position + s direction| = radius in the horizontal plane
    const Vector2d p = position_m.head<2>();
    const Vector2d d = direction.head<2>();
    const double a = std::max(1e-12, d.squaredNorm());
    const double b = p.dot(d);
    const double c = p.squaredNorm() - radius_m * radius_m;
    double s = (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
    if (direction.z() < 0) s = std::min(s, (ground_m - position_m.z()) / direction.z());
    return position_m + s * direction - Vector3d{0, 0, viewpoint_m};
}

UnitGeometry UnitGeometry::Plane(int width_px, int height_px) {
    UnitGeometry geometry;
    geometry.view_ = Projection::Plane(width_px, height_px);
    geometry.camera_count_ = 1;
    geometry.cameras_[0].model.width_px = width_px;
    geometry.cameras_[0].model.height_px = height_px;
    return geometry;
}

UnitGeometry UnitGeometry::Ring(const Projection& view, std::span<const CameraGeometry> cameras,
                                const AlignmentSurface& surface) {
    UnitGeometry geometry;
    geometry.view_ = view;
    geometry.surface_ = surface;
    geometry.camera_count_ = static_cast<int>(std::min(cameras.size(), kMaxCameras));
    for (int i = 0; i < geometry.camera_count_; ++i) {
        const CameraGeometry& camera = cameras[static_cast<std::size_t>(i)];
        geometry.cameras_[static_cast<std::size_t>(i)] = {
            camera.model, camera.T_unit_camera.linear().transpose(),
            camera.T_unit_camera.translation(), std::cos(camera.model.max_theta_rad)};
    }
    return geometry;
}

bool UnitGeometry::Project(int camera, const Vector3d& ray, Vector2d& pixel) const {
    if (!view_.IsRing()) {
        pixel = ray.hnormalized();
        return true;
    }
    return ProjectPoint(mounted(camera), surface_.Hit(ray), pixel);
}

bool UnitGeometry::ProjectPoint(const MountedCamera& camera, const Vector3d& p_unit_m,
                                Vector2d& pixel) {
    const Vector3d p_camera_m = camera.R_camera_unit * (p_unit_m - camera.position_m);
    // Most cameras look elsewhere, and the lens model is dear.
    if (p_camera_m.z() < camera.least_cosine * p_camera_m.norm()) return false;
    const auto projected = camera.model.Project(p_camera_m);
    if (projected) pixel = *projected;
    return projected.has_value();
}

std::optional<Vector3d> UnitGeometry::ViewRay(int camera, const Vector2d& pixel) const {
    if (!view_.IsRing()) return pixel.homogeneous();
    const MountedCamera& c = mounted(camera);
    const auto direction = c.model.Unproject(pixel);
    if (!direction) return std::nullopt;
    return surface_.RayOf(c.position_m, c.R_camera_unit.transpose() * *direction);
}

void UnitGeometry::See(const Vector3d& ray, const CameraMask& present, Sights& sights) const {
    sights.clear();
    if (!view_.IsRing()) {
        sights.push_back({0, ray.hnormalized(), present[0] ? 1.0 : 0.0});
        return;
    }
    const Vector3d p_unit_m = surface_.Hit(ray);
    for (int i = 0; i < camera_count_; ++i) {
        CameraSight sight{i, Vector2d::Zero(), -1};
        const MountedCamera& camera = mounted(i);
        if (!ProjectPoint(camera, p_unit_m, sight.pixel)) continue;
        if (present[static_cast<std::size_t>(i)])
            sight.weight = SideMargin(camera.model.width_px, camera.model.height_px, sight.pixel);
        sights.push_back(sight);
    }
    ShareByMargins(sights);
}

void UnitGeometry::ShareByMargins(Sights& sights) {
    double best = 0;
    for (const CameraSight& sight : sights) best = std::max(best, sight.weight);
    double sum = 0;
    for (CameraSight& sight : sights) {
        sight.weight = sight.weight < 0 ? 0 : std::max(0.0, sight.weight - best + kBlendWidth);
        sum += sight.weight;
    }
    if (sum <= 0) return;
    for (CameraSight& sight : sights) sight.weight /= sum;
}

double UnitGeometry::PixelsAtHorizon(int camera) const {
    if (!view_.IsRing()) return 1;
    const auto ray_at = [&](int x) { return view_.Ray({x, view_.horizon_y_px}); };
    double sum = 0;
    int columns = 0;
    for (int x = 0; x + 1 < view_.width_px; ++x) {
        Vector2d a;
        Vector2d b;
        if (MainCamera(ray_at(x)) != camera) continue;
        if (!Project(camera, ray_at(x), a) || !Project(camera, ray_at(x + 1), b)) continue;
        sum += (b - a).norm();
        ++columns;
    }
    return columns == 0 ? 1 : sum / columns;
}

std::optional<int> UnitGeometry::MainCamera(const Vector3d& ray) const {
    Sights sights;
    See(ray, sights);
    const auto best = std::max_element(
        sights.begin(), sights.end(),
        [](const CameraSight& a, const CameraSight& b) { return a.weight < b.weight; });
    if (best == sights.end() || best->weight <= 0) return std::nullopt;
    return best->camera;
}

std::optional<SightLine> UnitGeometry::SightAlong(const Vector3d& ray) const {
    const std::optional<int> maybe_camera = MainCamera(ray);
    if (!maybe_camera) return std::nullopt;
    return SightOf(*maybe_camera, ray);
}

SightLine UnitGeometry::SightOf(int camera, const Vector3d& ray) const {
    // The view shows a point of the surface where the camera sees it: the lens cancels out.
    const Vector3d& origin_m = mounted(camera).position_m;
    return {origin_m, (surface_.Hit(ray) - origin_m).normalized()};
}

}  // namespace hitchview::algo
