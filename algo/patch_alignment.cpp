#include "algo/patch_alignment.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "algo/integer_patch.hpp"
#include "algo/pixel_rounding.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector2i;

constexpr int kUnit = IntegerPatch::kUnit;

constexpr double Square(double x) {
    return x * x;
}

/// kArea^2 times the covariance of two values over a patch, from their sums.
double Covariance(std::int32_t product, std::int32_t a, std::int32_t b) {
    return static_cast<double>(std::int64_t{IntegerPatch::kArea} * product - std::int64_t{a} * b);
}

/// True if the patch around `centre`, `spare` px more on each side, and one more to the right and
/// below for interpolation, lie inside.
bool Fits(const cv::Mat1b& image, const Vector2f& centre, int spare) {
    const auto left = static_cast<float>(IntegerPatch::kLeft + spare);
    const auto right = static_cast<float>(IntegerPatch::kRight + spare);
    return centre.x() >= left && centre.y() >= left &&
           centre.x() < static_cast<float>(image.cols - 1) - right &&
           centre.y() < static_cast<float>(image.rows - 1) - left;
}

/// The patch that is looked for. Sums of products are covariances, times kArea^2, in the
/// units of TemplatePatch.
struct Template {
    TemplatePatch patch;
    TemplateSums sums;
    double variance;
    Vector2d slope_grey;
    Matrix2d inverse_hessian;
};

/// False if there is too little texture.
bool MakeTemplate(const cv::Mat1b& image, const Vector2i& centre, float min_strength, Template& t) {
    SampleTemplate(image, centre.x(), centre.y(), t.patch);
    t.sums = SumTemplate(t.patch);
    const TemplateSums& s = t.sums;
    const double a = Covariance(s.xx, s.x, s.x);
    const double b = Covariance(s.xy, s.x, s.y);
    const double c = Covariance(s.yy, s.y, s.y);
    constexpr double kSquaredUnit = Square(TemplatePatch::kSlopeUnit * IntegerPatch::kArea);
    const double smaller = 0.5 * (a + c - std::sqrt((a - c) * (a - c) + 4 * b * b));
    if (smaller < double{min_strength} * kSquaredUnit) return false;
    Matrix2d hessian;
    hessian << a, b, b, c;
    t.inverse_hessian = hessian.inverse();
    t.variance = Covariance(s.gg, s.g, s.g);
    t.slope_grey = {Covariance(s.gx, s.g, s.x), Covariance(s.gy, s.g, s.y)};
    return true;
}

double Correlation(const Template& t, const IntegerPatch& patch) {
    const SampleSums s = SumSample(t.patch, patch);
    const double variance = std::max(1.0, Covariance(s.pp, s.p, s.p));
    return Covariance(SumProducts(t.patch.grey, patch), t.sums.g, s.p) /
           std::sqrt(t.variance * variance);
}

/// One Gauss-Newton step from where `patch` was sampled.
Vector2f Step(const Template& t, const IntegerPatch& patch) {
    const SampleSums s = SumSample(t.patch, patch);
    const double gain = std::sqrt(t.variance / std::max(1.0, Covariance(s.pp, s.p, s.p)));
    const Vector2d slope_patch{Covariance(s.xp, t.sums.x, s.p), Covariance(s.yp, t.sums.y, s.p)};
    constexpr double kUnits = double{TemplatePatch::kSlopeUnit} / IntegerPatch::kGreyUnit;
    const Vector2d step = -kUnits * (t.inverse_hessian * (gain * slope_patch - t.slope_grey));
    return step.cast<float>();
}

/// Moves `at` to where `image` looks like the template; false if it leaves or runs away. `patch` is
/// what was sampled last. Samples lie on a grid of 1 / kUnit px; the last step leads off it.
bool Descend(const Template& t, const cv::Mat1b& image, const PatchAlignmentOptions& options,
             Vector2f& at, IntegerPatch& patch) {
    const Vector2f start = at;
    for (int i = 0; i < options.max_steps; ++i) {
        const Vector2i sampled = Round(at * kUnit);
        const Vector2f here = sampled.cast<float>() / kUnit;
        if (!Fits(image, here, 0)) return false;
        SamplePatch(image, sampled.x(), sampled.y(), patch);
        const Vector2f step = Step(t, patch);
        at = here + step;
        if (step.squaredNorm() < options.enough_px * options.enough_px) break;
    }
    return Fits(image, at, 0) && (at - start).norm() <= options.max_travel_px;
}

}  // namespace

std::optional<PatchMatch> AlignPatch(const GreyPyramid& from, const GreyPyramid& to,
                                     const Vector2f& from_px, const Vector2f& guess_px,
                                     int coarsest, const PatchAlignmentOptions& options) {
    Vector2f at = guess_px;
    Template t;
    IntegerPatch patch;
    for (int l = std::min(coarsest, from.levels() - 1); l >= options.finest_level; --l) {
        const float scale = 1.0F / static_cast<float>(1 << l);
        const Vector2f exact = from_px * scale;
        // What is followed lies on the grid of samples, beside the feature.
        const Vector2i centre = Round(exact * kUnit);
        const Vector2f followed = centre.cast<float>() / kUnit;
        const Vector2f beside = followed - exact;
        Vector2f moved = at * scale + beside;
        const bool textured = Fits(from.level(l), followed, 1) &&
                              MakeTemplate(from.level(l), centre, options.min_strength, t);
        if (textured && Descend(t, to.level(l), options, moved, patch)) {
            at = (moved - beside) / scale;
        } else if (l == options.finest_level) {
            return std::nullopt;
        }
    }
    return PatchMatch{at, static_cast<float>(Correlation(t, patch))};
}

}  // namespace hitchview::algo
