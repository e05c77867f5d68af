#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "calib/unit_problem.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::tests {

/// A board of tags, 1.1 m wide and 0.85 m high, 48 corners.
inline constexpr calib::Board kYardBoard{
    .columns = 4, .rows = 3, .square_m = 0.3, .pattern = calib::Pattern::kTags, .tag_m = 0.24};

/// The simulated rig's unit with boards round it: what its cameras see, and what is true.
class UnitYard {
 public:
    UnitYard(algo::Unit unit, unsigned seed) : random_(seed) {
        for (const auto& camera : drivers::SimulatedRigGeometry(1280, 720)) {
            if (camera.unit != unit) continue;
            const Eigen::Vector3d ahead = camera.geometry.T_unit_camera.linear().col(2);
            problem_.cameras.push_back({.name = std::string(camera.name),
                                        .model = camera.geometry.model,
                                        .yaw_rad = std::atan2(ahead.y(), ahead.x())});
            T_unit_camera_.push_back(camera.geometry.T_unit_camera);
        }
    }

    /// Upright, its middle at `middle_m`, turned to `toward_m` and from there by `tilt_rad` about
    /// its own axes x and y.
    static Eigen::Isometry3d Standing(const Eigen::Vector3d& middle_m,
                                      const Eigen::Vector3d& toward_m, double tilt_rad) {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        const Eigen::Vector3d away = (middle_m - toward_m).normalized();
        const Eigen::Vector3d right = away.cross(Eigen::Vector3d::UnitZ()).normalized();
        T.linear() << right, away.cross(right), away;
        T.linear() = T.linear() * Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(0.7 * tilt_rad, Eigen::Vector3d::UnitX());
        const Eigen::Vector3d last = kYardBoard.Corner(kYardBoard.count() - 2);
        T.translation() = middle_m - T.linear() * (last / 2);
        return T;
    }

    /// Before a camera, `right_px` and `down_px` from the middle of its picture.
    [[nodiscard]] Eigen::Isometry3d Before(std::size_t camera, double right_px, double down_px,
                                           double distance_m, double tilt_rad) const {
        const algo::CameraModel& lens = problem_.cameras[camera].model;
        const auto ray = lens.Unproject({lens.cx_px + right_px, lens.cy_px + down_px});
        const Eigen::Isometry3d& T = T_unit_camera_[camera];
        return Standing(T * (distance_m * *ray), T.translation(), tilt_rad);
    }

    std::size_t AddTarget(const Eigen::Isometry3d& T_unit_target, bool moves = false) {
        const std::size_t index = problem_.targets.size();
        problem_.targets.push_back(
            {.name = "target" + std::to_string(index), .board = kYardBoard, .moves = moves});
        T_unit_target_.push_back(T_unit_target);
        return index;
    }

    /// Measures the outermost corners of a target.
    void Survey(std::size_t index, double sigma_m) {
        std::normal_distribution<double> error(0, sigma_m);
        calib::UnitTarget& target = problem_.targets[index];
        target.sigma_m = sigma_m;
        const int columns = kYardBoard.columns;
        const int last = kYardBoard.tags() - 1;
        for (const int corner :
             {0, 4 * (columns - 1) + 1, 4 * last + 2, 4 * (last - columns + 1) + 3}) {
            const Eigen::Vector3d p = kYardBoard.Corner(corner);
            // One draw a statement: in which order arguments are evaluated differs between
            // processors.
            const double z = error(random_);
            const double y = error(random_);
            const double x = error(random_);
            target.surveyed.push_back({p, T_unit_target_[index] * p + Eigen::Vector3d(x, y, z)});
        }
    }

    /// All cameras take a picture.
    void Shoot(const std::string& shot, double noise_px = 0.3) {
        for (std::size_t camera = 0; camera < problem_.cameras.size(); ++camera) {
            for (std::size_t target = 0; target < problem_.targets.size(); ++target)
                See(camera, target, shot, noise_px);
        }
    }

    calib::UnitProblem& problem() { return problem_; }
    std::vector<Eigen::Isometry3d>& T_unit_camera() { return T_unit_camera_; }
    std::vector<Eigen::Isometry3d>& T_unit_target() { return T_unit_target_; }
    std::mt19937& random() { return random_; }
    /// Of the corners of a target over what its board says.
    void SetSize(double size) { size_ = size; }

 private:
    void See(std::size_t camera, std::size_t target, const std::string& shot, double noise_px) {
        std::normal_distribution<double> noise(0, noise_px);
        const Eigen::Isometry3d T = T_unit_camera_[camera].inverse() * T_unit_target_[target];
        calib::Sighting sighting{camera, target, shot, {}};
        for (int i = 0; i < kYardBoard.count(); ++i) {
            const Eigen::Vector3d p = T * (size_ * kYardBoard.Corner(i));
            constexpr double kMostAslant = 0.25;
            if (p.normalized().dot(T.linear().col(2)) < kMostAslant) return;
            const algo::CameraModel& lens = problem_.cameras[camera].model;
            const auto at = lens.Project(p);
            if (!at || at->x() < 0 || at->y() < 0 || at->x() > lens.width_px - 1 ||
                at->y() > lens.height_px - 1)
                continue;
            const double y_px = noise(random_);
            const double x_px = noise(random_);
            sighting.corners.push_back({i, *at + Eigen::Vector2d(x_px, y_px)});
        }
        if (!sighting.corners.empty()) problem_.sightings.push_back(std::move(sighting));
    }

    calib::UnitProblem problem_;
    std::vector<Eigen::Isometry3d> T_unit_camera_;
    std::vector<Eigen::Isometry3d> T_unit_target_;
    std::mt19937 random_;
    double size_ = 1;
};

/// Boards of its own before each camera, surveyed, in a wide triangle: so an error in where the
/// corners are turns the camera little.
inline constexpr std::size_t kBoardsBeforeEach = 4;
inline void SurveyBoardsBeforeEach(UnitYard& yard, double sigma_m) {
    for (std::size_t camera = 0; camera < yard.problem().cameras.size(); ++camera) {
        yard.Survey(yard.AddTarget(yard.Before(camera, 440, 150, 2.5, 0.5)), sigma_m);
        yard.Survey(yard.AddTarget(yard.Before(camera, -440, 150, 2.5, -0.5)), sigma_m);
        yard.Survey(yard.AddTarget(yard.Before(camera, 0, -220, 3.5, 0.3)), sigma_m);
        yard.Survey(yard.AddTarget(yard.Before(camera, -150, 60, 5.5, 0.3)), sigma_m);
    }
}

/// Carries a board past every two neighbours so that both see it, and takes a picture each time.
/// Cameras are neighbours in the order of their directions; `shots` for each two.
inline void CarryBoardPastNeighbours(UnitYard& yard, int shots) {
    const auto& cameras = yard.problem().cameras;
    const std::size_t carried = yard.AddTarget(Eigen::Isometry3d::Identity(), true);
    int shot = 0;
    for (std::size_t a = 0; a < cameras.size(); ++a) {
        for (std::size_t b = a + 1; b < cameras.size(); ++b) {
            const double between =
                std::remainder(cameras[b].yaw_rad - cameras[a].yaw_rad, 2 * std::numbers::pi);
            if (std::abs(between) > 1.3) continue;
            const double yaw_rad = cameras[a].yaw_rad + between / 2;
            const Eigen::Vector3d middle =
                (yard.T_unit_camera()[a].translation() + yard.T_unit_camera()[b].translation()) / 2;
            for (int i = 0; i < shots; ++i) {
                const double distance_m = 2.5 + 0.5 * (i % 3);
                const double turn_rad = yaw_rad + 0.06 * (i % 5 - 2);
                const Eigen::Vector3d ahead(std::cos(turn_rad), std::sin(turn_rad), 0);
                const Eigen::Vector3d up(0, 0, 0.35 * (i % 3 - 1) - 0.2);
                yard.T_unit_target()[carried] = UnitYard::Standing(
                    middle + distance_m * ahead + up, middle, 0.5 * (i % 2 == 0 ? 1 : -1));
                yard.Shoot("carried" + std::to_string(100 + shot++));
            }
        }
    }
}

}  // namespace hitchview::tests
