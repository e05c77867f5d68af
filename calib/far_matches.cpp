#include "calib/far_matches.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearestFar_m = 10;
/// How far rays of one thing may be apart because the cameras are only roughly known.
constexpr double kRough_rad = 0.02;
constexpr double kHalfView = 1.2;  // tangent of the angle from the middle of the view to its edge
constexpr double kClearly = 0.75;  // best over second best distance of descriptors
constexpr int kFewestPixels = 2000;
constexpr int kMostFeatures = 3000;
/// Features that reach across the edge of what both see would be of the edge.
constexpr int kEdge_px = 8;

/// A view without distortion between two cameras.
struct CommonView {
    Matrix3d R_unit_view;
    double focal_px;
    int size_px;

    [[nodiscard]] Vector3d RayOf(double x, double y) const {
        const double middle = (size_px - 1) / 2.0;
        return R_unit_view * Vector3d(x - middle, y - middle, focal_px);
    }
};

CommonView Between(const UnitCamera& a, const UnitCamera& b, const Isometry3d& T_unit_a,
                   const Isometry3d& T_unit_b) {
    const Vector3d ahead = (T_unit_a.linear().col(2) + T_unit_b.linear().col(2)).normalized();
    const Vector3d right = (T_unit_a.linear().col(0) + T_unit_b.linear().col(0));
    CommonView view;
    view.R_unit_view.col(2) = ahead;
    view.R_unit_view.col(1) = ahead.cross(right).normalized();
    view.R_unit_view.col(0) = view.R_unit_view.col(1).cross(ahead);
    view.focal_px = std::max(a.model.fx_px, b.model.fx_px);
    view.size_px = static_cast<int>(2 * kHalfView * view.focal_px);
    return view;
}

/// One camera's picture of what is far away, and where it has one.
struct Redrawn {
    cv::Mat picture;
    cv::Mat1b seen;
};

Redrawn Redraw(const CommonView& view, const algo::CameraModel& model,
               const Isometry3d& T_unit_camera, const cv::Mat& picture) {
    const cv::Size size(view.size_px, view.size_px);
    cv::Mat2f map(size, cv::Vec2f(-1, -1));
    Redrawn redrawn{{}, cv::Mat1b(size, 0)};
    const Matrix3d R_camera_unit = T_unit_camera.linear().transpose();
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const auto at = model.Project(R_camera_unit * view.RayOf(x, y));
            if (!at || at->x() < 0 || at->y() < 0 || at->x() > model.width_px - 1 ||
                at->y() > model.height_px - 1)
                continue;
            map(y, x) = {static_cast<float>(at->x()), static_cast<float>(at->y())};
            redrawn.seen(y, x) = 255;
        }
    }
    cv::remap(picture, redrawn.picture, map, cv::noArray(), cv::INTER_LINEAR);
    return redrawn;
}

struct Features {
    std::vector<cv::KeyPoint> points;
    cv::Mat descriptors;
};

/// Within `box`; points of the whole view.
Features Detect(const Redrawn& redrawn, const cv::Mat1b& mask, const cv::Rect& box) {
    Features features;
    cv::SIFT::create(kMostFeatures)
        ->detectAndCompute(redrawn.picture(box), mask(box), features.points, features.descriptors);
    for (cv::KeyPoint& point : features.points) point.pt += cv::Point2f(box.tl());
    return features;
}

/// For each feature the other that is clearly the best, or -1.
std::vector<int> Best(const Features& of, const Features& among) {
    std::vector<int> best(of.points.size(), -1);
    if (of.points.empty() || among.points.size() < 2) return best;
    std::vector<std::vector<cv::DMatch>> matches;
    cv::BFMatcher(cv::NORM_L2).knnMatch(of.descriptors, among.descriptors, matches, 2);
    for (const auto& two : matches) {
        if (two.size() == 2 && two[0].distance < kClearly * two[1].distance)
            best[static_cast<std::size_t>(two[0].queryIdx)] = two[0].trainIdx;
    }
    return best;
}

/// Matches of one pair of cameras.
class PairMatcher {
 public:
    PairMatcher(const std::vector<UnitCamera>& cameras, std::span<const Isometry3d> T_unit_camera,
                std::size_t first, std::size_t second)
        : first_(first),
          second_(second),
          a_(cameras[first].model),
          b_(cameras[second].model),
          T_unit_a_(T_unit_camera[first]),
          T_unit_b_(T_unit_camera[second]),
          view_(Between(cameras[first], cameras[second], T_unit_a_, T_unit_b_)) {}

    void Match(const cv::Mat& picture_a, const cv::Mat& picture_b,
               std::vector<FarMatch>& matches) const {
        const Redrawn a = Redraw(view_, a_, T_unit_a_, picture_a);
        const Redrawn b = Redraw(view_, b_, T_unit_b_, picture_b);
        cv::Mat1b mask;
        cv::bitwise_and(a.seen, b.seen, mask);
        cv::erode(mask, mask, cv::Mat1b(2 * kEdge_px + 1, 2 * kEdge_px + 1, 1), {-1, -1}, 1,
                  cv::BORDER_CONSTANT, cv::Scalar(0));
        if (cv::countNonZero(mask) < kFewestPixels) return;
        const cv::Rect box = cv::boundingRect(mask);
        const Features of_a = Detect(a, mask, box);
        const Features of_b = Detect(b, mask, box);
        const std::vector<int> to_b = Best(of_a, of_b);
        const std::vector<int> to_a = Best(of_b, of_a);
        for (std::size_t i = 0; i < to_b.size(); ++i) {
            if (to_b[i] < 0) continue;
            const auto k = static_cast<std::size_t>(to_b[i]);
            if (to_a[k] == static_cast<int>(i)) Add(of_a.points[i].pt, of_b.points[k].pt, matches);
        }
    }

 private:
    void Add(const cv::Point2f& at_a, const cv::Point2f& at_b,
             std::vector<FarMatch>& matches) const {
        const double baseline_m = (T_unit_a_.translation() - T_unit_b_.translation()).norm();
        const double farthest_px = (kRough_rad + baseline_m / kNearestFar_m) * view_.focal_px *
                                   (1 + kHalfView * kHalfView);
        if (cv::norm(at_a - at_b) > farthest_px) return;
        const auto pixel_a = PixelOf(a_, T_unit_a_, at_a);
        const auto pixel_b = PixelOf(b_, T_unit_b_, at_b);
        if (pixel_a && pixel_b) matches.push_back({first_, second_, *pixel_a, *pixel_b});
    }

    [[nodiscard]] std::optional<Vector2d> PixelOf(const algo::CameraModel& model,
                                                  const Isometry3d& T_unit_camera,
                                                  const cv::Point2f& at) const {
        return model.Project(T_unit_camera.linear().transpose() * view_.RayOf(at.x, at.y));
    }

    std::size_t first_;
    std::size_t second_;
    const algo::CameraModel& a_;
    const algo::CameraModel& b_;
    const Isometry3d& T_unit_a_;
    const Isometry3d& T_unit_b_;
    CommonView view_;
};

}  // namespace

std::optional<double> BestInverseDistance(const FarMatch& match, const UnitProblem& problem,
                                          std::span<const Isometry3d> T_unit_camera,
                                          double& angle_rad) {
    const Isometry3d& first = T_unit_camera[match.first];
    const Isometry3d& second = T_unit_camera[match.second];
    const auto from_first = problem.cameras[match.first].model.Unproject(match.first_px);
    const auto from_second = problem.cameras[match.second].model.Unproject(match.second_px);
    if (!from_first || !from_second) return std::nullopt;
    const Vector3d ray = first.linear() * *from_first;
    const Vector3d other = second.linear() * *from_second;
    const Vector3d baseline = first.translation() - second.translation();
    // |(ray + baseline / distance) x other| is least.
    const Vector3d change = baseline.cross(other);
    const double inverse_m =
        std::clamp(-ray.cross(other).dot(change) / change.squaredNorm(), 0.0, 1 / kNearestFar_m);
    const Vector3d seen = ray + inverse_m * baseline;
    angle_rad = std::atan2(seen.cross(other).norm(), seen.dot(other));
    return inverse_m;
}

std::vector<FarMatch> FindFarMatches(const std::vector<UnitCamera>& cameras,
                                     std::span<const Isometry3d> T_unit_camera,
                                     std::span<const cv::Mat> pictures) {
    std::vector<FarMatch> matches;
    for (std::size_t a = 0; a < cameras.size(); ++a) {
        for (std::size_t b = a + 1; b < cameras.size(); ++b) {
            const double cosine =
                T_unit_camera[a].linear().col(2).dot(T_unit_camera[b].linear().col(2));
            constexpr double kOpposite = -0.3;
            if (cosine < kOpposite) continue;
            PairMatcher(cameras, T_unit_camera, a, b).Match(pictures[a], pictures[b], matches);
        }
    }
    return matches;
}

std::vector<NeighbourMisalignment> Misalignments(const UnitProblem& problem,
                                                 std::span<const Isometry3d> T_unit_camera) {
    std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> angles;
    for (const FarMatch& match : problem.far_matches) {
        double angle_rad = 0;
        if (BestInverseDistance(match, problem, T_unit_camera, angle_rad))
            angles[{match.first, match.second}].push_back(angle_rad);
    }
    std::vector<NeighbourMisalignment> misalignments;
    for (auto& [pair, of_pair] : angles) {
        const auto middle = of_pair.begin() + std::ssize(of_pair) / 2;
        std::ranges::nth_element(of_pair, middle);
        misalignments.push_back({pair.first, pair.second, of_pair.size(), *middle});
    }
    return misalignments;
}

}  // namespace hitchview::calib
