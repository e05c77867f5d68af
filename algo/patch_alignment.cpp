#include "algo/patch_alignment.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Matrix2f;
using Eigen::Vector2f;

constexpr int kSide = 15;  // px, odd
constexpr int kHalf = kSide / 2;
constexpr int kArea = kSide * kSide;

template <int kN>
using Patch = Eigen::Array<float, kN * kN, 1>;

/// True if a patch of kN px around `centre`, and one pixel more for interpolation, lies inside.
template <int kN>
bool Fits(const cv::Mat1b& image, const Vector2f& centre) {
    constexpr float kReach = kN / 2;
    return centre.x() >= kReach && centre.y() >= kReach &&
           centre.x() < static_cast<float>(image.cols - 1) - kReach &&
           centre.y() < static_cast<float>(image.rows - 1) - kReach;
}

/// Bilinear samples around `centre`; Fits must hold.
template <int kN>
void ReadPatch(const cv::Mat1b& image, const Vector2f& centre, Patch<kN>& patch) {
    const float left = centre.x() - kN / 2;
    const float top = centre.y() - kN / 2;
    const int x0 = static_cast<int>(left);
    const int y0 = static_cast<int>(top);
    const float fx = left - static_cast<float>(x0);
    const float fy = top - static_cast<float>(y0);
    const float w00 = (1 - fx) * (1 - fy);
    const float w01 = fx * (1 - fy);
    const float w10 = (1 - fx) * fy;
    const float w11 = fx * fy;
    for (int y = 0; y < kN; ++y) {
        const std::uint8_t* a = image[y0 + y] + x0;
        const std::uint8_t* b = image[y0 + y + 1] + x0;
        float* out = patch.data() + y * kN;
        for (int x = 0; x < kN; ++x) {
            out[x] = w00 * static_cast<float>(a[x]) + w01 * static_cast<float>(a[x + 1]) +
                     w10 * static_cast<float>(b[x]) + w11 * static_cast<float>(b[x + 1]);
        }
    }
}

struct Moments {
    float mean;
    float deviation;  // root of the sum of squares about the mean
};

Moments Measure(const Patch<kSide>& patch) {
    const float mean = patch.mean();
    return {mean, std::sqrt((patch - mean).square().sum())};
}

/// The patch that is looked for: zero-mean grey, zero-mean slopes, and the inverse of the sum of
/// their outer products.
struct Template {
    Patch<kSide> grey;
    Patch<kSide> slope_x;
    Patch<kSide> slope_y;
    float deviation;
    Matrix2f inverse_hessian;
};

void CutTemplate(const Patch<kSide + 2>& wide, Template& t) {
    constexpr int kWide = kSide + 2;
    for (int y = 0; y < kSide; ++y) {
        const float* row = wide.data() + (y + 1) * kWide + 1;
        for (int x = 0; x < kSide; ++x) {
            const int i = y * kSide + x;
            t.grey[i] = row[x];
            t.slope_x[i] = 0.5F * (row[x + 1] - row[x - 1]);
            t.slope_y[i] = 0.5F * (row[x + kWide] - row[x - kWide]);
        }
    }
}

bool MakeTemplate(const cv::Mat1b& image, const Vector2f& centre, float min_strength, Template& t) {
    Patch<kSide + 2> wide;
    ReadPatch<kSide + 2>(image, centre, wide);
    CutTemplate(wide, t);
    t.grey -= t.grey.mean();
    t.slope_x -= t.slope_x.mean();
    t.slope_y -= t.slope_y.mean();
    t.deviation = Measure(t.grey).deviation;

    const float a = t.slope_x.square().sum();
    const float b = (t.slope_x * t.slope_y).sum();
    const float c = t.slope_y.square().sum();
    const float smaller = 0.5F * (a + c - std::sqrt((a - c) * (a - c) + 4 * b * b));
    if (smaller < min_strength * kArea) return false;
    Matrix2f hessian;
    hessian << a, b, b, c;
    t.inverse_hessian = hessian.inverse();
    return true;
}

float Correlation(const Template& t, const Patch<kSide>& patch, const Moments& m) {
    return (t.grey * (patch - m.mean)).sum() / std::max(1e-3F, t.deviation * m.deviation);
}

Vector2f Step(const Template& t, const Patch<kSide>& patch, const Moments& m) {
    const float gain = t.deviation / std::max(1e-3F, m.deviation);
    const Patch<kSide> error = gain * (patch - m.mean) - t.grey;
    return -(t.inverse_hessian * Vector2f{(t.slope_x * error).sum(), (t.slope_y * error).sum()});
}

/// Moves `at` to where `image` looks like the template; false if it leaves or runs away.
bool Descend(const Template& t, const cv::Mat1b& image, const PatchAlignmentOptions& options,
             Vector2f& at) {
    const Vector2f start = at;
    Patch<kSide> patch;
    for (int i = 0; i < options.max_steps; ++i) {
        if (!Fits<kSide>(image, at)) return false;
        ReadPatch<kSide>(image, at, patch);
        const Vector2f step = Step(t, patch, Measure(patch));
        at += step;
        if (step.squaredNorm() < options.enough_px * options.enough_px) break;
    }
    return Fits<kSide>(image, at) && (at - start).norm() <= options.max_travel_px;
}

}  // namespace

std::optional<PatchMatch> AlignPatch(const GreyPyramid& from, const GreyPyramid& to,
                                     const Vector2f& from_px, const Vector2f& guess_px,
                                     int coarsest, const PatchAlignmentOptions& options) {
    Vector2f at = guess_px;
    Template t;
    for (int l = std::min(coarsest, from.levels() - 1); l >= options.finest_level; --l) {
        const float scale = 1.0F / static_cast<float>(1 << l);
        const Vector2f centre = from_px * scale;
        Vector2f moved = at * scale;
        const bool fits = Fits<kSide + 2>(from.level(l), centre) && Fits<kSide>(to.level(l), moved);
        const bool textured = fits && MakeTemplate(from.level(l), centre, options.min_strength, t);
        if (textured && Descend(t, to.level(l), options, moved)) {
            at = moved / scale;
        } else if (l == options.finest_level) {
            return std::nullopt;
        }
    }
    Patch<kSide> patch;
    const int finest = options.finest_level;
    ReadPatch<kSide>(to.level(finest), at / static_cast<float>(1 << finest), patch);
    return PatchMatch{at, Correlation(t, patch, Measure(patch))};
}

}  // namespace hitchview::algo
