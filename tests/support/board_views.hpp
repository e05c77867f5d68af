#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "calib/lens_solver.hpp"

namespace hitchview::tests {

/// A wide fisheye of a vehicle, 1280x720.
inline algo::CameraModel FisheyeLens() {
    return {.kind = algo::CameraModel::Kind::kKannalaBrandt4,
            .width_px = 1280,
            .height_px = 720,
            .fx_px = 602,
            .fy_px = 600,
            .cx_px = 644,
            .cy_px = 355,
            .distortion = {0.03, -0.012, 0.004, -0.001},
            .max_theta_rad = 1.5};
}

inline algo::CameraModel PinholeLens() {
    return {.kind = algo::CameraModel::Kind::kPinholeRadtan,
            .width_px = 1280,
            .height_px = 720,
            .fx_px = 905,
            .fy_px = 900,
            .cx_px = 636,
            .cy_px = 364,
            .distortion = {-0.25, 0.09, 0.0008, -0.0005, -0.015},
            .max_theta_rad = 0.9};
}

/// What a person holds before a camera: all over the picture, near and far, tilted.
class BoardViews {
 public:
    BoardViews(const algo::CameraModel& lens, const calib::Board& board, unsigned seed)
        : lens_(lens),
          board_m_(board.Corners()),
          board_(board),
          fewest_corners_(board.count()),
          random_(seed) {}

    /// From now on the paper is like this.
    void Bulge(double depth_m) {
        for (int i = 0; i < board_.count(); ++i) {
            const double x = 2.0 * (i % board_.columns) / (board_.columns - 1) - 1;
            const double y = 2.0 * (i / board_.columns) / (board_.rows - 1) - 1;
            board_m_[static_cast<std::size_t>(i)].z() = depth_m * (x * x + 0.5 * x * y * y);
        }
    }
    void SetMostTilt(double tilt_rad) { most_tilt_rad_ = tilt_rad; }
    /// Boards may reach beyond the picture, as those with tags.
    void ShowParts() { fewest_corners_ = board_.count() / 3; }

    [[nodiscard]] const std::vector<Eigen::Vector3d>& board_m() const { return board_m_; }

    calib::LensProblem Problem(int views, double noise_px) {
        calib::LensProblem problem{.kind = lens_.kind,
                                   .width_px = lens_.width_px,
                                   .height_px = lens_.height_px,
                                   .board = board_,
                                   .views = {}};
        while (std::ssize(problem.views) < views) {
            if (auto view = View(noise_px)) problem.views.push_back(std::move(*view));
        }
        return problem;
    }

 private:
    /// Empty where too little of the board lies in the picture.
    std::optional<calib::SeenCorners> View(double noise_px) {
        const Eigen::Isometry3d T_camera_board = Place();
        std::normal_distribution<double> noise(0, noise_px);
        calib::SeenCorners corners;
        for (int i = 0; i < board_.count(); ++i) {
            const auto at = lens_.Project(T_camera_board * board_m_[static_cast<std::size_t>(i)]);
            if (!at || at->x() < 0 || at->y() < 0 || at->x() >= lens_.width_px ||
                at->y() >= lens_.height_px)
                continue;
            corners.push_back({i, {at->x() + noise(random_), at->y() + noise(random_)}});
        }
        if (std::ssize(corners) < fewest_corners_) return std::nullopt;
        return corners;
    }

    Eigen::Isometry3d Place() {
        std::uniform_real_distribution<double> u(-1, 1);
        const auto direction = lens_.Unproject({lens_.width_px * (0.5 + 0.45 * u(random_)),
                                                lens_.height_px * (0.5 + 0.45 * u(random_))});
        const double width_m = (board_.columns - 1) * board_.square_m;
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        const Eigen::Vector3d middle = (board_.Corner(0) + board_.Corner(board_.count() - 1)) / 2;
        // One draw a statement: in which order operands are evaluated differs between processors.
        const double sine = std::sin(3 * u(random_));
        const double cosine = std::cos(3 * u(random_));
        const double roll_rad = 0.2 * u(random_);
        const double tilt_rad = most_tilt_rad_ * u(random_);
        const Eigen::Vector3d axis = Eigen::Vector3d(cosine, sine, 0).normalized();
        T.linear() = (Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), *direction) *
                      Eigen::AngleAxisd(tilt_rad, axis) *
                      Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()))
                         .toRotationMatrix();
        T.translation() = *direction * width_m * (1.2 + 0.6 * u(random_)) - T.linear() * middle;
        return T;
    }

    algo::CameraModel lens_;
    std::vector<Eigen::Vector3d> board_m_;
    calib::Board board_;
    int fewest_corners_;
    std::mt19937 random_;
    double most_tilt_rad_ = 0.8;
};

}  // namespace hitchview::tests
