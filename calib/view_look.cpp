#include "calib/view_look.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "calib/board_pattern.hpp"
#include "calib/median.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;

struct Patch {
    double dark_grey = 0;
    double white_grey = 0;
    double steepest = 0;  ///< grey per px
};

/// The steepest slope between ink and paper tells the blur of an edge.
Patch Measure(const cv::Mat& grey, const cv::Rect& around) {
    cv::Mat smooth;
    cv::Mat along;
    cv::Mat down;
    cv::Mat slope;
    double dark = 0;
    Patch patch;
    cv::blur(grey(around), smooth, {3, 3});
    cv::minMaxLoc(smooth, &patch.dark_grey, &patch.white_grey);
    cv::Sobel(grey(around), along, CV_32F, 1, 0, 3, 1.0 / 8);
    cv::Sobel(grey(around), down, CV_32F, 0, 1, 3, 1.0 / 8);
    cv::magnitude(along, down, slope);
    cv::minMaxLoc(slope, &dark, &patch.steepest);
    return patch;
}

Eigen::Matrix3d BoardHomography(const Board& board, const SeenCorners& corners) {
    std::vector<cv::Point2d> from;
    std::vector<cv::Point2d> to;
    for (const SeenCorner& corner : corners) {
        const Eigen::Vector3d at_m = board.Corner(corner.index);
        from.emplace_back(at_m.x(), at_m.y());
        to.emplace_back(corner.at_px.x(), corner.at_px.y());
    }
    if (from.size() < 4) return Eigen::Matrix3d::Zero();
    const cv::Mat H = cv::findHomography(from, to);
    if (H.empty()) return Eigen::Matrix3d::Zero();
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(H.ptr<double>());
}

/// Change of position in the picture with that on the board.
Eigen::Matrix2d Jacobian(const Eigen::Matrix3d& H, const Vector2d& at_m) {
    const Eigen::Vector3d seen = H * at_m.homogeneous();
    return (H.topLeftCorner<2, 2>() - seen.hnormalized() * H.bottomLeftCorner<1, 2>()) / seen.z();
}

Tilt Direction(const Vector2d& away) {
    if (std::abs(away.x()) > std::abs(away.y()))
        return away.x() > 0 ? Tilt::kRightAway : Tilt::kLeftAway;
    return away.y() > 0 ? Tilt::kBottomAway : Tilt::kTopAway;
}

}  // namespace

std::optional<CornerLook> LookAtCorners(const cv::Mat& grey, const SeenCorners& corners) {
    constexpr int kReach_px = 6;
    std::vector<double> blur_px;
    std::vector<double> dark_grey;
    std::vector<double> white_grey;
    for (const SeenCorner& corner : corners) {
        const cv::Rect around(static_cast<int>(corner.at_px.x()) - kReach_px,
                              static_cast<int>(corner.at_px.y()) - kReach_px, 2 * kReach_px + 1,
                              2 * kReach_px + 1);
        if ((around & cv::Rect({0, 0}, grey.size())) != around) continue;
        const Patch patch = Measure(grey, around);
        // The slope of a step blurred by a Gaussian is steepest in its middle.
        blur_px.push_back((patch.white_grey - patch.dark_grey) /
                          (std::sqrt(2 * std::numbers::pi) * std::max(patch.steepest, 1e-3)));
        dark_grey.push_back(patch.dark_grey);
        white_grey.push_back(patch.white_grey);
    }
    if (blur_px.empty()) return std::nullopt;
    return CornerLook{Median(blur_px), Median(dark_grey), Median(white_grey)};
}

std::optional<BoardPose> RoughPose(const Board& board, const SeenCorners& corners,
                                   const Vector2d& picture_px) {
    constexpr double kFacing = 0.12;  // most change of distance over a board that faces the camera
    const Eigen::Matrix3d H = BoardHomography(board, corners);
    const BoardRectangle area = PatternArea(board);
    Vector2d middle_m = Vector2d::Zero();
    for (const SeenCorner& corner : corners) middle_m += board.Corner(corner.index).head<2>();
    middle_m /= std::max(1.0, static_cast<double>(corners.size()));
    const double depth = (H * middle_m.homogeneous()).z();
    if (!(std::abs(depth) > 1e-12)) return std::nullopt;
    const Eigen::Matrix2d scale = Jacobian(H, middle_m);
    const Vector2d growth = H.bottomLeftCorner<1, 2>().transpose() / depth;
    const Vector2d over_board = growth.cwiseProduct(area.size_m());
    BoardPose pose;
    if (over_board.norm() > kFacing) pose.tilt = Direction(scale * growth);
    const Vector2d sides_px(scale.col(0).norm() * area.size_m().x(),
                            scale.col(1).norm() * area.size_m().y());
    pose.size = sides_px.maxCoeff() / picture_px.maxCoeff();
    return pose;
}

}  // namespace hitchview::calib
