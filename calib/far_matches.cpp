#include "calib/far_matches.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/far_consensus.hpp"
#include "calib/median.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearestFar_m = 10;
/// How far rays of one thing may be apart because the cameras are only roughly known.
constexpr double kRough_rad = 0.05;
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
    std::vector<Vector3d> rays;  ///< of unit length
    cv::Mat descriptors;
};

/// Within `box`; points of the whole view.
Features Detect(const CommonView& view, const Redrawn& redrawn, const cv::Mat1b& mask,
                const cv::Rect& box) {
    Features features;
    constexpr int kLayers = 3;
    constexpr double kLeastContrast = 0.02;
    cv::SIFT::create(kMostFeatures, kLayers, kLeastContrast)
        ->detectAndCompute(redrawn.picture(box), mask(box), features.points, features.descriptors);
    for (cv::KeyPoint& point : features.points) {
        point.pt += cv::Point2f(box.tl());
        features.rays.push_back(view.RayOf(point.pt.x, point.pt.y).normalized());
    }
    return features;
}

/// 128 numbers.
Eigen::Map<const Eigen::VectorXf> Descriptor(const Features& features, std::size_t i) {
    return {features.descriptors.ptr<float>(static_cast<int>(i)), features.descriptors.cols};
}

/// For each feature the other that is clearly the best of those that lie where its thing could be,
/// from 10 m to infinity; or -1. `baseline_m`: from the camera of `among` to that of `of`.
std::vector<int> Best(const Features& of, const Features& among, const Vector3d& baseline_m) {
    const double least_cosine =
        std::cos(std::min(1.0, kRough_rad + baseline_m.norm() / kNearestFar_m));
    std::vector<int> best(of.points.size(), -1);
    for (std::size_t i = 0; i < of.points.size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        double second = least;
        for (std::size_t k = 0; k < among.points.size(); ++k) {
            if (of.rays[i].dot(among.rays[k]) < least_cosine ||
                AngleAtBestDistance(of.rays[i], among.rays[k], baseline_m).angle_rad > kRough_rad)
                continue;
            const double distance = (Descriptor(of, i) - Descriptor(among, k)).norm();
            second = std::min(second, std::max(distance, least));
            if (distance >= least) continue;
            least = distance;
            best[i] = static_cast<int>(k);
        }
        if (least >= kClearly * second) best[i] = -1;
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
        const Features of_a = Detect(view_, a, mask, box);
        const Features of_b = Detect(view_, b, mask, box);
        const Vector3d baseline_m = T_unit_a_.translation() - T_unit_b_.translation();
        const std::vector<int> to_b = Best(of_a, of_b, baseline_m);
        const std::vector<int> to_a = Best(of_b, of_a, -baseline_m);
        for (std::size_t i = 0; i < to_b.size(); ++i) {
            if (to_b[i] < 0) continue;
            const auto k = static_cast<std::size_t>(to_b[i]);
            if (to_a[k] == static_cast<int>(i)) Add(of_a.points[i].pt, of_b.points[k].pt, matches);
        }
    }

 private:
    void Add(const cv::Point2f& at_a, const cv::Point2f& at_b,
             std::vector<FarMatch>& matches) const {
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

BestDistance AngleAtBestDistance(const Vector3d& first, const Vector3d& second,
                                 const Vector3d& baseline_m) {
    // |(first + baseline / distance) x second| is least.
    const Vector3d change = baseline_m.cross(second);
    const double inverse_m =
        std::clamp(-first.cross(second).dot(change) / change.squaredNorm(), 0.0, 1 / kNearestFar_m);
    const Vector3d seen = first + inverse_m * baseline_m;
    return {inverse_m, std::atan2(seen.cross(second).norm(), seen.dot(second))};
}

std::optional<double> BestInverseDistance(const FarMatch& match, const UnitProblem& problem,
                                          std::span<const Isometry3d> T_unit_camera,
                                          double& angle_rad) {
    const Isometry3d& first = T_unit_camera[match.first];
    const Isometry3d& second = T_unit_camera[match.second];
    const auto from_first = problem.cameras[match.first].model.Unproject(match.first_px);
    const auto from_second = problem.cameras[match.second].model.Unproject(match.second_px);
    if (!from_first || !from_second) return std::nullopt;
    const BestDistance best =
        AngleAtBestDistance(first.linear() * *from_first, second.linear() * *from_second,
                            first.translation() - second.translation());
    angle_rad = best.angle_rad;
    return best.inverse_m;
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
            std::vector<FarMatch> of_pair;
            PairMatcher(cameras, T_unit_camera, a, b).Match(pictures[a], pictures[b], of_pair);
            std::ranges::move(AgreeingMatches(of_pair, cameras, T_unit_camera),
                              std::back_inserter(matches));
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
    for (const auto& [pair, of_pair] : angles) {
        misalignments.push_back({pair.first, pair.second, of_pair.size(), Median(of_pair)});
    }
    return misalignments;
}

}  // namespace hitchview::calib
