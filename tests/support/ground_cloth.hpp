#pragma once

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algo/camera_model.hpp"
#include "calib/board.hpp"
#include "calib/saddle.hpp"

namespace hitchview::tests {

/// A car on a cloth of 6 x 10 m whose rim is checkered, squares of .4 m, in four fisheye pictures
/// (stills/fisheye-car of the test data). Each picture's file has the lens and a map of the ground.
/// The cloth as a board: columns from left to right, rows from front to rear.
inline constexpr calib::Board kGroundCloth{.columns = 14, .rows = 24, .square_m = 0.4};

struct ClothPicture {
    std::string name;
    cv::Mat grey{};
    cv::Mat colour{};
    algo::CameraModel model{};
    calib::SeenCorners corners{};
};

/// Reads one picture and finds the cloth's corners in it, led by its map of the ground.
class ClothReader {
 public:
    ClothReader(const std::string& folder, const std::string& name) : picture_{.name = name} {
        picture_.colour = cv::imread(folder + "/" + name + ".png");
        picture_.grey = cv::imread(folder + "/" + name + ".png", cv::IMREAD_GRAYSCALE);
        const cv::FileStorage file(folder + "/" + name + ".yaml", cv::FileStorage::READ);
        camera_ = file["camera_matrix"].mat();
        distortion_ = file["dist_coeffs"].mat();
        map_ = file["project_matrix"].mat();
        scale_ = file["scale_xy"].mat();
        shift_ = file["shift_xy"].mat();
        picture_.model = Model();
    }

    ClothPicture Read() {
        for (int index = 0; index < kGroundCloth.count(); ++index) {
            if (const auto at = Find(index)) picture_.corners.push_back({index, *at});
        }
        return picture_;
    }

 private:
    [[nodiscard]] algo::CameraModel Model() const {
        algo::CameraModel model{.kind = algo::CameraModel::Kind::kKannalaBrandt4,
                                .width_px = picture_.grey.cols,
                                .height_px = picture_.grey.rows,
                                .fx_px = camera_(0, 0),
                                .fy_px = camera_(1, 1),
                                .cx_px = camera_(0, 2),
                                .cy_px = camera_(1, 2),
                                .max_theta_rad = 2.0};
        for (int i = 0; i < 4; ++i) model.distortion[static_cast<std::size_t>(i)] = distortion_(i);
        return model;
    }

    /// Centimetres on the cloth, from its front left corner, to the map of this picture.
    [[nodiscard]] cv::Vec3d OnMap(double right, double back) const {
        constexpr double kRim = 300;
        constexpr double kWidth = 1199;
        constexpr double kLength = 1599;
        const double x = right + kRim;
        const double y = back + kRim;
        if (picture_.name == "back") return {kWidth - x, kLength - y, 1};
        if (picture_.name == "left") return {kLength - y, x, 1};
        if (picture_.name == "right") return {y, kWidth - x, 1};
        return {x, y, 1};
    }

    /// Where the map says that a place on the cloth is seen; empty behind the camera.
    [[nodiscard]] std::optional<Eigen::Vector2d> Rough(double column, double row) const {
        constexpr double kSquare_cm = 40;
        const cv::Vec3d flat =
            map_.inv() * OnMap((column + 1) * kSquare_cm, (row + 1) * kSquare_cm);
        // A map has any sign: the middle of its near edge is in front of the camera.
        const cv::Vec3d ahead = map_.inv() * cv::Vec3d(600, 350, 1);
        if (flat[2] * ahead[2] <= 0) return std::nullopt;
        const double a =
            (flat[0] / flat[2] - camera_(0, 2) - shift_(0)) / (camera_(0, 0) * scale_(0));
        const double b =
            (flat[1] / flat[2] - camera_(1, 2) - shift_(1)) / (camera_(1, 1) * scale_(1));
        return picture_.model.Project({a, b, 1});
    }

    [[nodiscard]] std::optional<Eigen::Vector2d> Find(int index) const {
        const int column = index % kGroundCloth.columns;
        const int row = index / kGroundCloth.columns;
        const auto at = Rough(column, row);
        const auto along = Rough(column + 0.5, row);
        const auto down = Rough(column, row + 0.5);
        if (!at || !along || !down) return std::nullopt;
        const auto found = calib::FindSaddle(
            picture_.grey, {*at, *along - *at, *down - *at, (column + row) % 2 == 0});
        return found;
    }

    ClothPicture picture_;
    cv::Matx33d camera_;
    cv::Mat1d distortion_;
    cv::Matx33d map_;
    cv::Mat1f scale_;
    cv::Mat1f shift_;
};

}  // namespace hitchview::tests
