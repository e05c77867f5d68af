#include "drivers/simulated_sun.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hitchview::drivers {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kDisc_rad = 0.6 * kDegree;  // its edge is soft over as much again

/// Falls off exponentially round the sun, grey levels.
struct Bloom {
    double level;
    double reach_rad;
};
constexpr double kDiscLevel = 900;
constexpr std::array kBlooms{Bloom{420, 2.5 * kDegree}, Bloom{130, 9 * kDegree}};
constexpr double kVeil = 26;                    // all over the picture, with the sun in its middle
constexpr double kFarthest_rad = 80 * kDegree;  // off the axis: from there on the hood is in shadow

/// Reflections: where on the line from the sun (1) through the middle (0), and how large.
struct Ghost {
    double at;
    double radius_rad;
    double level;
};
constexpr std::array kGhosts{Ghost{0.45, 1.6 * kDegree, 22}, Ghost{-0.35, 3 * kDegree, 16},
                             Ghost{-0.8, 4.5 * kDegree, 11}};

double Angle(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// From the optical axis towards `ray`, `share` of the angle.
Vector3d AlongFromAxis(const Vector3d& ray, double share) {
    const Vector3d axis = Vector3d::UnitZ().cross(ray);
    const double angle_rad = Angle(Vector3d::UnitZ(), ray);
    if (axis.norm() < 1e-9) return Vector3d::UnitZ();
    return Eigen::AngleAxisd(share * angle_rad, axis.normalized()) * Vector3d::UnitZ();
}

std::uint8_t Byte(double value) {
    return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

/// What saturates has no colour left.
std::uint8_t Bleached(std::uint8_t chroma, double glare) {
    const double kept = std::exp(-glare / 120);
    return Byte(128 + kept * (chroma - 128.0));
}

}  // namespace

LowSun::LowSun(const SceneOptions::Sun& sun, const algo::CameraModel& lens)
    : direction_(std::cos(sun.elevation_rad) * std::cos(sun.azimuth_rad),
                 std::cos(sun.elevation_rad) * std::sin(sun.azimuth_rad),
                 std::sin(sun.elevation_rad)),
      strength_(sun.strength),
      lens_(lens) {
    rays_camera_.reserve(static_cast<std::size_t>(lens.width_px * lens.height_px));
    for (int y = 0; y < lens.height_px; ++y) {
        for (int x = 0; x < lens.width_px; ++x)
            rays_camera_.push_back(lens.Unproject({x, y}).value_or(Vector3d::Zero()));
    }
}

double LowSun::GlareAt(const Vector3d& ray, const Vector3d& sun) const {
    const double off_rad = Angle(ray, sun);
    double glare = kDiscLevel * std::clamp(2 - off_rad / kDisc_rad, 0.0, 1.0);
    for (const Bloom& bloom : kBlooms) glare += bloom.level * std::exp(-off_rad / bloom.reach_rad);
    return glare;
}

void LowSun::DrawOver(const Shot& shot, std::span<std::uint8_t> nv12) const {
    const Vector3d sun = shot.T_world_camera.linear().transpose() * direction_;
    const double off_axis_rad = Angle(Vector3d::UnitZ(), sun);
    if (off_axis_rad >= kFarthest_rad || shot.free <= 0) return;
    // Grows from nothing as the sun comes over the edge of the hood.
    const double reaches = std::min(1.0, (kFarthest_rad - off_axis_rad) / (12 * kDegree));
    const double scale = strength_ * shot.free * shot.gain * reaches;
    std::array<Vector3d, kGhosts.size()> ghosts;
    for (std::size_t i = 0; i < ghosts.size(); ++i) ghosts[i] = AlongFromAxis(sun, kGhosts[i].at);
    const int width = lens_.width_px;
    std::uint8_t* chroma = nv12.data() + static_cast<std::ptrdiff_t>(width) * lens_.height_px;
    for (int y = 0; y < lens_.height_px; ++y) {
        for (int x = 0; x < width; ++x) {
            const Vector3d& ray = rays_camera_[static_cast<std::size_t>(y * width + x)];
            double glare = GlareAt(ray, sun) + kVeil * std::cos(off_axis_rad);
            for (std::size_t i = 0; i < ghosts.size(); ++i) {
                if (Angle(ray, ghosts[i]) < kGhosts[i].radius_rad) glare += kGhosts[i].level;
            }
            glare *= scale;
            std::uint8_t& luma = nv12[static_cast<std::size_t>(y * width + x)];
            luma = Byte(luma + glare);
            if (y % 2 != 0 || x % 2 != 0) continue;
            std::uint8_t* uv = chroma + y / 2 * width + x;
            uv[0] = Bleached(uv[0], glare);
            uv[1] = Bleached(uv[1], glare);
        }
    }
}

}  // namespace hitchview::drivers
