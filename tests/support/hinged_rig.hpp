#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "algo/feature_motion.hpp"
#include "algo/unit.hpp"
#include "algo/unit_geometry.hpp"

namespace hitchview::tests {

inline constexpr double kDegree = std::numbers::pi / 180;

/// A tractor and a trailer with two side cameras each: 0.9 m from the hitch point, 0.72 m to the
/// side, 1.7 m above the ground, lenses of 120 degrees.
inline algo::CameraGeometry SideCamera(double x_m, double y_m, double yaw_rad) {
    algo::CameraGeometry camera;
    camera.model = {.kind = algo::CameraModel::Kind::kKannalaBrandt4,
                    .width_px = 1280,
                    .height_px = 720,
                    .fx_px = 640 / (60 * kDegree),
                    .fy_px = 640 / (60 * kDegree),
                    .cx_px = 639.5,
                    .cy_px = 359.5,
                    .max_theta_rad = 1.5};
    Eigen::Matrix3d facing_forward;
    facing_forward << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    const Eigen::AngleAxisd heading(yaw_rad, Eigen::Vector3d::UnitZ());
    camera.T_unit_camera.linear() = heading.toRotationMatrix() * facing_forward;
    camera.T_unit_camera.translation() = Eigen::Vector3d{x_m, y_m, 1.3};
    return camera;
}

inline algo::PerUnit<algo::UnitGeometry> HingedRig() {
    using std::numbers::pi;
    const algo::AlignmentSurface surface{};
    const auto unit = [&](double x_m, double yaw_rad, double centre_rad) {
        const std::array cameras{SideCamera(x_m, 0.72, yaw_rad), SideCamera(x_m, -0.72, -yaw_rad)};
        return algo::UnitGeometry::Ring(algo::Projection::Cylinder(2048, 360, 0.5, centre_rad),
                                        cameras, surface);
    };
    return {{unit(0.9, 70 * kDegree, 0), unit(-0.9, pi / 2, pi)}};
}

/// How the trailer stands: the hinge with play.
inline Eigen::Isometry3d TrailerPose(double yaw_rad, double pitch_rad, double roll_rad,
                                     const Eigen::Vector3d& slip_m) {
    Eigen::Isometry3d T_tractor_trailer = Eigen::Isometry3d::Identity();
    T_tractor_trailer.translation() = slip_m;
    T_tractor_trailer.linear() = (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    return T_tractor_trailer;
}

/// A scene round the rig and how both units' views show it.
class HingedScene {
 public:
    struct Options {
        double nearest_m = 3, farthest_m = 80;
        double lowest_m = 0, highest_m = 6;  ///< above the ground
        double noise_px = 0.3;
        double outlier_share = 0.3;
        double play_rad = 1.5 * kDegree;  ///< roll and pitch, largest
        double slip_m = 0.03;             ///< largest of each coordinate
    };

    HingedScene(const algo::PerUnit<algo::UnitGeometry>& rig, const Options& options,
                std::uint32_t seed)
        : rig_(rig), options_(options), random_(seed) {}

    /// `inliers` pairs that both units see, in both overlaps, and wrong ones beside them.
    algo::PerOverlap<algo::InterFeatures> See(double yaw_rad, int inliers) {
        const double p = options_.play_rad;
        const double s = options_.slip_m;
        const Eigen::Isometry3d T_tractor_trailer = TrailerPose(
            yaw_rad, Within(-p, p), Within(-p, p), {Within(-s, s), Within(-s, s), Within(-s, s)});
        algo::PerOverlap<algo::InterFeatures> features;
        for (int seen = 0; seen < inliers;) seen += Add(T_tractor_trailer, features) ? 1 : 0;
        Spoil(features, inliers);
        return features;
    }

 private:
    double Within(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random_);
    }

    Eigen::Vector3d ScenePoint() {
        const double distance_m =
            options_.nearest_m * std::pow(options_.farthest_m / options_.nearest_m, Within(0, 1));
        const double azimuth = Within(-std::numbers::pi, std::numbers::pi);
        return {distance_m * std::cos(azimuth), distance_m * std::sin(azimuth),
                -0.4 + Within(options_.lowest_m, options_.highest_m)};
    }

    /// Pixel of the unit's view, from the camera with the largest share there.
    std::optional<Eigen::Vector2d> Pixel(algo::Unit unit, const Eigen::Vector3d& p_unit_m) {
        const algo::UnitGeometry& geometry = rig_[unit];
        for (const double side : {1.0, -1.0}) {
            const double x_m = unit == algo::Unit::kTractor ? 0.9 : -0.9;
            const Eigen::Vector3d eye_m{x_m, 0.72 * side, 1.3};
            const Eigen::Vector3d ray = algo::AlignmentSurface{}.RayOf(eye_m, p_unit_m - eye_m);
            const Eigen::Vector2d pixel = geometry.view().Pixel(ray);
            const auto sight = geometry.SightAlong(ray);
            const bool in_view = pixel.y() > 0 && pixel.y() < geometry.view().height_px - 1;
            if (in_view && sight && (sight->origin_m - eye_m).norm() < 1e-9) return Noisy(pixel);
        }
        return std::nullopt;
    }

    Eigen::Vector2d Noisy(const Eigen::Vector2d& pixel) {
        std::normal_distribution<double> noise(0, options_.noise_px);
        const double x = noise(random_);
        return pixel + Eigen::Vector2d{x, noise(random_)};
    }

    bool Add(const Eigen::Isometry3d& T_tractor_trailer,
             algo::PerOverlap<algo::InterFeatures>& features) {
        const Eigen::Vector3d p_tractor_m = ScenePoint();
        const auto tractor = Pixel(algo::Unit::kTractor, p_tractor_m);
        const auto trailer = Pixel(algo::Unit::kTrailer, T_tractor_trailer.inverse() * p_tractor_m);
        if (!tractor || !trailer) return false;
        const auto overlap = p_tractor_m.y() > 0 ? algo::Overlap::kLeft : algo::Overlap::kRight;
        return features[overlap].push_back({*tractor, *trailer});
    }

    /// Adds pairs whose trailer pixel is some other one of the same overlap, moved.
    void Spoil(algo::PerOverlap<algo::InterFeatures>& features, int inliers) {
        const int wrong = static_cast<int>(
            std::lround(inliers * options_.outlier_share / (1 - options_.outlier_share)));
        for (int i = 0; i < wrong; ++i) {
            auto& of = features[i % 2 == 0 ? algo::Overlap::kLeft : algo::Overlap::kRight];
            if (of.empty()) continue;
            const auto any = [&] { return static_cast<std::size_t>(random_()) % of.size(); };
            const Eigen::Vector2d tractor_px = of[any()].tractor_px;
            const Eigen::Vector2d trailer_px = of[any()].trailer_px;
            of.push_back(
                {tractor_px, trailer_px + Eigen::Vector2d{Within(-60, 60), Within(-40, 40)}});
        }
    }

    const algo::PerUnit<algo::UnitGeometry>& rig_;
    Options options_;
    std::mt19937 random_;
};

}  // namespace hitchview::tests
