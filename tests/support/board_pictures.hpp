#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "calib/board.hpp"
#include "tests/support/board_scene.hpp"

namespace hitchview::tests {

/// Pictures as a person takes them with one camera: the board all over the picture, near and far,
/// tilted; light, focus and noise change a little from one to the next.
class BoardPictures {
 public:
    BoardPictures(const algo::CameraModel& lens, const calib::Board& board, unsigned seed)
        : lens_(lens), board_(board), scene_(lens), random_(seed) {
        for (const Eigen::Vector3d& corner : board.Corners())
            width_m_ = std::max(width_m_, corner.x());
    }

    /// Where the board is held next. A board without tags lies in the picture as a whole.
    Eigen::Isometry3d NextPlace() {
        for (;;) {
            const Eigen::Isometry3d T_camera_board = AnyPlace();
            if (Share(T_camera_board) >= fewest_) return T_camera_board;
        }
    }

    cv::Mat1b Picture(const Eigen::Isometry3d& T_camera_board, double blur_px = 0.8) {
        std::uniform_real_distribution<double> any(-1, 1);
        const BoardSceneOptions options{.blur_px = blur_px * (1 + 0.2 * any(random_)),
                                        .gain = 0.8 + 0.25 * any(random_),
                                        .offset = 8 * any(random_),
                                        .noise_grey = 3,
                                        .seed = static_cast<unsigned>(random_())};
        const PlacedBoard placed{board_, T_camera_board};
        return scene_.Render(Eigen::Isometry3d::Identity(), {&placed, 1}, options);
    }

 private:
    Eigen::Isometry3d AnyPlace() {
        std::uniform_real_distribution<double> any(-1, 1);
        const double y_px = lens_.height_px * (0.5 + 0.47 * any(random_));
        const double x_px = lens_.width_px * (0.5 + 0.47 * any(random_));
        const double distance_m = width_m_ * (1.3 + 0.5 * any(random_));
        const double turn_rad = 0.2 * any(random_);
        const double axis_rad = 3 * any(random_);
        const double tilt_rad = 0.9 * any(random_);
        return Held(lens_, board_, {x_px, y_px}, distance_m, tilt_rad, axis_rad, turn_rad);
    }

    /// Of the corners, those in the picture.
    [[nodiscard]] double Share(const Eigen::Isometry3d& T_camera_board) const {
        constexpr double kRim_px = 8;
        int seen = 0;
        for (const Eigen::Vector3d& corner : board_.Corners()) {
            const auto at = lens_.Project(T_camera_board * corner);
            if (at && at->x() > kRim_px && at->y() > kRim_px &&
                at->x() < lens_.width_px - kRim_px && at->y() < lens_.height_px - kRim_px)
                ++seen;
        }
        return static_cast<double>(seen) / board_.count();
    }

    algo::CameraModel lens_;
    calib::Board board_;
    BoardScene scene_;
    std::mt19937 random_;
    double width_m_ = 0;
    double fewest_ = board_.pattern == calib::Pattern::kCheckerboard ? 1.0 : 0.4;
};

}  // namespace hitchview::tests
