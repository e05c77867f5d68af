#include "algo/hinge_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kUnknowns = 6;  // yaw, pitch, roll, slip x, y, z
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Information = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr int kFewestInliers = 3;
/// Yaw is hardly known before: this keeps the equations regular where no pair tells it.
constexpr double kYawBefore_rad = 0.7;
constexpr double kLargestStep_rad = 0.15;
/// Points along the line between the cameras tell nothing and amplify the noise.
constexpr double kLeastSine = 0.05;
/// Parallax may be negative by noise only, in units of it.
constexpr double kLeastParallax = -4;
/// Minima of the search that are refined.
constexpr std::size_t kStarts = 4;
/// Above every cost.
constexpr double kNoStart = 2;

/// The trailer against the tractor.
struct Pose {
    Unknowns x;
    Matrix3d R;
    std::array<Vector3d, 3> axes;  // that yaw, pitch and roll turn about

    explicit Pose(const Unknowns& unknowns) : x(unknowns) {
        const Eigen::AngleAxisd yaw(x[0], Vector3d::UnitZ());
        const Eigen::AngleAxisd pitch(x[1], Vector3d::UnitY());
        const Eigen::AngleAxisd roll(x[2], Vector3d::UnitX());
        R = (yaw * pitch * roll).toRotationMatrix();
        axes = {Vector3d::UnitZ(), yaw * Vector3d::UnitY(), yaw * (pitch * Vector3d::UnitX())};
    }
    static Unknowns Yawed(double yaw_rad) { return yaw_rad * Unknowns::Unit(0); }
};

/// One pair under one pose, in the tractor's frame.
struct Epipolar {
    Epipolar(const SightPair& pair, const Pose& pose)
        : lever(pose.R * pair.trailer.origin_m),
          baseline(lever + pose.x.tail<3>() - pair.tractor.origin_m),
          tractor(pair.tractor.direction),
          trailer(pose.R * pair.trailer.direction) {
        const Vector3d normal = baseline.cross(trailer);
        const double e = tractor.dot(normal);
        const double squares = normal.squaredNorm() + tractor.cross(baseline).squaredNorm();
        const double least = kLeastSine * kLeastSine * baseline.squaredNorm();
        scale = 1 / std::sqrt(std::max(squares - 2 * e * e, least));
        residual_rad = scale * e;
        parallax_rad =
            normal.dot(tractor.cross(trailer)) / std::sqrt(std::max(normal.squaredNorm(), least));
    }

    /// Of the residual; the scale is taken to be constant.
    [[nodiscard]] Unknowns Gradient(const Pose& pose) const {
        Unknowns gradient;
        for (int i = 0; i < 3; ++i) {
            const Vector3d& axis = pose.axes[static_cast<std::size_t>(i)];
            gradient[i] =
                tractor.dot(axis.cross(lever).cross(trailer) + baseline.cross(axis.cross(trailer)));
        }
        gradient.tail<3>() = trailer.cross(tractor);
        return scale * gradient;
    }

    /// The scene lies in front of both cameras.
    [[nodiscard]] bool InFront(double noise_rad) const {
        return parallax_rad > kLeastParallax * noise_rad && tractor.dot(trailer) > 0;
    }

    Vector3d lever;     // from the hitch point to the trailer's camera
    Vector3d baseline;  // from the tractor's camera to the trailer's
    Vector3d tractor;
    Vector3d trailer;
    double scale;
    double residual_rad;
    double parallax_rad;
};

/// Normal equations at one pose.
struct Normal {
    Information A = Information::Zero();
    Unknowns b = Unknowns::Zero();
    double squares = 0;
    int inliers = 0;
};

/// The fit to one set of pairs.
class Problem {
 public:
    Problem(std::span<const SightPair> pairs, const HingeFitOptions& options,
            const MagsacCost& robust)
        : pairs_(pairs), options_(options), robust_(robust) {}

    /// Mean over every `stride`th pair, in [0, 1].
    [[nodiscard]] double Cost(const Pose& pose, double noise_rad, std::size_t stride) const {
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < pairs_.size(); i += stride) {
            const Epipolar epipolar(pairs_[i], pose);
            const double r = epipolar.residual_rad / noise_rad;
            sum += epipolar.InFront(noise_rad) ? robust_.Cost(r * r) : 1;
            ++count;
        }
        return sum / count;
    }

    [[nodiscard]] std::optional<HingeFit> Solve(double yaw_rad, double noise_rad) const {
        const Unknowns expected = Pose::Yawed(yaw_rad);
        const Unknowns before = InformationBefore();
        Pose pose(expected);
        Information A;
        int inliers = 0;
        for (int i = 0; i < options_.iterations; ++i) {
            const Normal normal = Linearise(pose, noise_rad);
            inliers = normal.inliers;
            if (inliers < kFewestInliers) return std::nullopt;
            A = normal.A;
            A.diagonal() += before;
            Unknowns step = -A.ldlt().solve(normal.b + before.cwiseProduct(pose.x - expected));
            step[0] = std::clamp(step[0], -kLargestStep_rad, kLargestStep_rad);
            pose = Pose(pose.x + step);
            const double agreed_rad = std::sqrt(normal.squares / inliers);
            noise_rad = std::clamp(agreed_rad, options_.least_noise_rad, noise_rad);
        }
        if (std::abs(pose.x[0]) > options_.largest_yaw_rad) return std::nullopt;
        const double variance = A.ldlt().solve(Unknowns::Unit(0))[0];
        return HingeFit{pose.x[0], std::sqrt(variance), noise_rad, inliers,
                        Cost(pose, options_.refine_noise_rad, 1)};
    }

 private:
    /// What is known of the unknowns before any pair was seen.
    [[nodiscard]] Unknowns InformationBefore() const {
        const double play = 1 / (options_.roll_pitch_rad * options_.roll_pitch_rad);
        const double slip = 1 / (options_.slip_m * options_.slip_m);
        Unknowns before;
        before << 1 / (kYawBefore_rad * kYawBefore_rad), play, play, slip, slip, slip;
        return before;
    }

    [[nodiscard]] Normal Linearise(const Pose& pose, double noise_rad) const {
        Normal normal;
        for (const SightPair& pair : pairs_) {
            const Epipolar epipolar(pair, pose);
            const double r = epipolar.residual_rad / noise_rad;
            const double weight = robust_.Weight(r * r);
            if (weight <= 0 || !epipolar.InFront(noise_rad)) continue;
            const Unknowns gradient = epipolar.Gradient(pose) / noise_rad;
            normal.A.noalias() += weight * gradient * gradient.transpose();
            normal.b += weight * r * gradient;
            normal.squares += epipolar.residual_rad * epipolar.residual_rad;
            ++normal.inliers;
        }
        return normal;
    }

    std::span<const SightPair> pairs_;
    const HingeFitOptions& options_;
    const MagsacCost& robust_;
};

/// A yaw that may be near the true one.
struct Start {
    double cost = kNoStart;
    double yaw_rad = 0;
};
using Starts = std::array<Start, kStarts>;

/// The lowest local minima over the range of the hinge, best first.
Starts FindStarts(const Problem& problem, const HingeFitOptions& options, std::size_t stride) {
    Starts starts;
    Start before;
    Start middle;
    for (int i = 0; i <= options.search_steps; ++i) {
        Start after;
        if (i < options.search_steps) {
            const double share = 2.0 * i / (options.search_steps - 1) - 1;
            after.yaw_rad = share * options.largest_yaw_rad;
            after.cost =
                problem.Cost(Pose(Pose::Yawed(after.yaw_rad)), options.search_noise_rad, stride);
        }
        const bool minimum = middle.cost <= before.cost && middle.cost < after.cost;
        if (minimum && middle.cost < starts.back().cost) {
            starts.back() = middle;
            std::sort(starts.begin(), starts.end(),
                      [](const Start& a, const Start& b) { return a.cost < b.cost; });
        }
        before = middle;
        middle = after;
    }
    return starts;
}

}  // namespace

HingeEstimator::HingeEstimator(const HingeFitOptions& options) : options_(options) {}

std::optional<HingeFit> HingeEstimator::Refine(std::span<const SightPair> pairs,
                                               double yaw_rad) const {
    return Problem(pairs, options_, robust_).Solve(yaw_rad, options_.refine_noise_rad);
}

std::optional<HingeFit> HingeEstimator::Search(std::span<const SightPair> pairs) const {
    const Problem problem(pairs, options_, robust_);
    const std::size_t stride = 1 + pairs.size() / static_cast<std::size_t>(options_.search_pairs);
    std::optional<HingeFit> best;
    for (const Start& start : FindStarts(problem, options_, stride)) {
        if (start.cost >= kNoStart) continue;
        const auto fit = problem.Solve(start.yaw_rad, options_.search_noise_rad);
        if (fit && (!best || fit->mean_cost < best->mean_cost)) best = fit;
    }
    return best;
}

}  // namespace hitchview::algo
