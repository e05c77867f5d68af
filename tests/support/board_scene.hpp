#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "algo/camera_model.hpp"
#include "calib/board.hpp"
#include "calib/board_pattern.hpp"

namespace hitchview::tests {

struct PlacedBoard {
    calib::Board board;
    Eigen::Isometry3d T_world_board = Eigen::Isometry3d::Identity();
};

struct BoardSceneOptions {
    double blur_px = 0;     ///< standard deviation of a Gaussian, of lens and motion
    double gain = 1;        ///< on grey 30 (ink), 225 (paper) and the background
    double offset = 0;      ///< grey, after the gain
    double noise_grey = 0;  ///< standard deviation
    int supersampling = 4;  ///< rays along the side of a pixel
    unsigned seed = 1;      ///< of the noise
    bool textured = true;   ///< smooth background; otherwise plain
};

/// T_camera_board of a board whose middle lies `distance_m` away where the lens has `pixel`. It
/// faces the camera, then is tilted about an axis in its plane, `axis_rad` from its rows, and
/// turned in its plane.
inline Eigen::Isometry3d Held(const algo::CameraModel& lens, const calib::Board& board,
                              const Eigen::Vector2d& pixel, double distance_m, double tilt_rad = 0,
                              double axis_rad = 0, double turn_rad = 0) {
    const Eigen::Vector3d direction = lens.Unproject(pixel).value();
    const calib::BoardRectangle pattern = calib::PatternArea(board);
    const Eigen::Vector2d middle = (pattern.from_m + pattern.to_m) / 2;
    const Eigen::Vector3d axis(std::cos(axis_rad), std::sin(axis_rad), 0);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() =
        (Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction) *
         Eigen::AngleAxisd(tilt_rad, axis) * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    T.translation() =
        distance_m * direction - T.linear() * Eigen::Vector3d(middle.x(), middle.y(), 0);
    return T;
}

/// A board as a picture: the share of white in each texel.
class BoardTexture {
 public:
    explicit BoardTexture(const calib::Board& board) {
        const calib::BoardRectangle pattern = calib::PatternArea(board);
        const Eigen::Vector2d rim_m = Eigen::Vector2d::Constant(calib::WhiteMargin_m(board));
        sheet_ = {pattern.from_m - rim_m, pattern.to_m + rim_m};
        texels_per_m_ = 2000 / sheet_.size_m().maxCoeff();
        const Eigen::Vector2d size = texels_per_m_ * sheet_.size_m();
        white_ = cv::Mat1f(static_cast<int>(std::ceil(size.y())),
                           static_cast<int>(std::ceil(size.x())), 1.F);
        for (const calib::BoardRectangle& dark : calib::DarkRectangles(board)) Darken(dark);
    }

    /// Share of white at a point of the board; empty beside the sheet.
    [[nodiscard]] std::optional<double> White(const Eigen::Vector2d& at_m) const {
        if ((at_m.array() < sheet_.from_m.array()).any() ||
            (at_m.array() > sheet_.to_m.array()).any())
            return std::nullopt;
        const Eigen::Vector2d at = Texel(at_m) - Eigen::Vector2d::Constant(0.5);
        const int x = std::clamp(static_cast<int>(at.x()), 0, white_.cols - 2);
        const int y = std::clamp(static_cast<int>(at.y()), 0, white_.rows - 2);
        const double u = std::clamp(at.x() - x, 0.0, 1.0);
        const double v = std::clamp(at.y() - y, 0.0, 1.0);
        return (1 - v) * ((1 - u) * white_(y, x) + u * white_(y, x + 1)) +
               v * ((1 - u) * white_(y + 1, x) + u * white_(y + 1, x + 1));
    }

    [[nodiscard]] const calib::BoardRectangle& sheet() const { return sheet_; }

 private:
    [[nodiscard]] Eigen::Vector2d Texel(const Eigen::Vector2d& at_m) const {
        return texels_per_m_ * (at_m - sheet_.from_m);
    }

    void Darken(const calib::BoardRectangle& dark) {
        const Eigen::Vector2d from = Texel(dark.from_m);
        const Eigen::Vector2d to = Texel(dark.to_m);
        const auto share = [](double low, double high, int texel) {
            return std::max(0.0, std::min(high, texel + 1.0) - std::max<double>(low, texel));
        };
        for (int y = static_cast<int>(from.y()); y < std::min<double>(to.y(), white_.rows); ++y) {
            for (int x = static_cast<int>(from.x()); x < std::min<double>(to.x(), white_.cols); ++x)
                white_(y, x) -=
                    static_cast<float>(share(from.y(), to.y(), y) * share(from.x(), to.x(), x));
        }
    }

    calib::BoardRectangle sheet_;
    double texels_per_m_ = 0;
    cv::Mat1f white_;
};

/// What a camera sees of boards; ray-traced. Makes many pictures with one lens quickly.
class BoardScene {
 public:
    explicit BoardScene(const algo::CameraModel& lens)
        : lens_(lens), rays_(lens.height_px + 1, lens.width_px + 1, cv::Vec3d(0, 0, 0)) {
        for (int y = 0; y < rays_.rows; ++y) {
            for (int x = 0; x < rays_.cols; ++x) {
                const auto ray = lens.Unproject({x - 0.5, y - 0.5});
                if (ray) rays_(y, x) = {ray->x(), ray->y(), ray->z()};
            }
        }
    }

    [[nodiscard]] cv::Mat1b Render(const Eigen::Isometry3d& T_world_camera,
                                   std::span<const PlacedBoard> boards,
                                   const BoardSceneOptions& options = {}) const {
        std::vector<Placed> placed;
        for (const PlacedBoard& board : boards)
            placed.push_back(
                {BoardTexture(board.board), T_world_camera.inverse() * board.T_world_board});
        cv::Mat1f light(lens_.height_px, lens_.width_px);
        for (int y = 0; y < light.rows; ++y) {
            for (int x = 0; x < light.cols; ++x)
                light(y, x) = static_cast<float>(Pixel(x, y, T_world_camera, placed, options));
        }
        return Exposed(light, options);
    }

 private:
    static constexpr double kInk = 30;
    static constexpr double kPaper = 225;
    static constexpr double kNoRay = 12;

    struct Placed {
        BoardTexture texture;
        Eigen::Isometry3d T_camera_board;
    };
    struct Hit {
        double distance = std::numeric_limits<double>::infinity();
        double grey = 0;
    };

    [[nodiscard]] bool HasRays(int x, int y) const {
        const cv::Vec3d none(0, 0, 0);
        return rays_(y, x) != none && rays_(y, x + 1) != none && rays_(y + 1, x) != none &&
               rays_(y + 1, x + 1) != none;
    }

    /// At (u, v) of [0, 1) in pixel (x, y).
    [[nodiscard]] Eigen::Vector3d Ray(int x, int y, double u, double v) const {
        const cv::Vec3d ray = (1 - v) * ((1 - u) * rays_(y, x) + u * rays_(y, x + 1)) +
                              v * ((1 - u) * rays_(y + 1, x) + u * rays_(y + 1, x + 1));
        return {ray[0], ray[1], ray[2]};
    }

    /// Distance along the ray and place on the board's plane; empty if it does not get there.
    static std::optional<std::pair<double, Eigen::Vector2d>> OnBoard(const Placed& board,
                                                                     const Eigen::Vector3d& ray) {
        const Eigen::Vector3d normal = board.T_camera_board.linear().col(2);
        const double distance = normal.dot(board.T_camera_board.translation()) / normal.dot(ray);
        if (!(distance > 0) || normal.dot(ray) <= 0) return std::nullopt;
        const Eigen::Vector3d at = board.T_camera_board.linear().transpose() *
                                   (distance * ray - board.T_camera_board.translation());
        return std::pair{distance, Eigen::Vector2d(at.head<2>())};
    }

    /// Whether any corner of the pixel is near a sheet, so that its middle alone will not do.
    static bool IsNear(const Placed& board, const Eigen::Vector3d& ray) {
        const auto on = OnBoard(board, ray);
        if (!on) return false;
        const auto& sheet = board.texture.sheet();
        const Eigen::Array2d rim = 0.1 * sheet.size_m().array();
        return (on->second.array() > sheet.from_m.array() - rim).all() &&
               (on->second.array() < sheet.to_m.array() + rim).all();
    }

    static double Background(const Eigen::Vector3d& d, bool textured) {
        if (!textured) return 110;
        return 110 +
               35 * std::sin(5 * d.x() + 2 * std::sin(3 * d.y())) * std::cos(4 * d.z() + d.y()) +
               20 * std::sin(23 * d.x() - 17 * d.z()) * std::sin(19 * d.y() + 3 * d.x());
    }

    static double Seen(const Eigen::Vector3d& ray, const Eigen::Isometry3d& T_world_camera,
                       const std::vector<Placed>& boards, bool textured) {
        Hit nearest;
        for (const Placed& board : boards) {
            const auto on = OnBoard(board, ray);
            if (!on || on->first >= nearest.distance) continue;
            const auto white = board.texture.White(on->second);
            if (white) nearest = {on->first, kInk + (kPaper - kInk) * *white};
        }
        return std::isfinite(nearest.distance)
                   ? nearest.grey
                   : Background(T_world_camera.linear() * ray.normalized(), textured);
    }

    [[nodiscard]] double Pixel(int x, int y, const Eigen::Isometry3d& T_world_camera,
                               const std::vector<Placed>& boards,
                               const BoardSceneOptions& options) const {
        if (!HasRays(x, y)) return kNoRay;
        const Eigen::Vector3d middle = Ray(x, y, 0.5, 0.5);
        const bool near =
            std::ranges::any_of(boards, [&](const Placed& board) { return IsNear(board, middle); });
        const int n = near ? options.supersampling : 1;
        double sum = 0;
        for (int i = 0; i < n * n; ++i)
            sum += Seen(Ray(x, y, (i % n + 0.5) / n, (i / n + 0.5) / n), T_world_camera, boards,
                        options.textured);
        return sum / (n * n);
    }

    static cv::Mat1b Exposed(cv::Mat1f light, const BoardSceneOptions& options) {
        if (options.blur_px > 0) cv::GaussianBlur(light, light, {}, options.blur_px);
        light = light * options.gain + options.offset;
        if (options.noise_grey > 0) {
            std::mt19937 random(options.seed);
            std::normal_distribution<float> noise(0, static_cast<float>(options.noise_grey));
            for (float& value : light) value += noise(random);
        }
        cv::Mat1b picture;
        light.convertTo(picture, CV_8U);
        return picture;
    }

    algo::CameraModel lens_;
    cv::Mat3d rays_;  ///< through the corners of the pixels; zero where the lens has none
};

}  // namespace hitchview::tests
