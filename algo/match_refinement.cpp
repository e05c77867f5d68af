#include "algo/match_refinement.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core/hal/intrin.hpp>

#include "algo/multiversion.hpp"
#include "algo/pixel_rounding.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix2f;
using Eigen::Vector2f;

constexpr int kHalf = 3;
constexpr int kSide = 2 * kHalf + 1;
constexpr int kArea = kSide * kSide;
constexpr int kSteps = 2;
constexpr float kFarthest_px = 2;
constexpr float kNear_px = 0.05F;  // a step no longer than this is the last
/// Pictures are read at eighths of a pixel, and give eighths of a grey level.
constexpr int kEighths = 8;
/// Variance of grey noise over that of the match.
constexpr float kPrior = 4.0F / (0.4F * 0.4F);
/// What tells less than this in both directions moves a match by no more than a hundredth.
constexpr float kTellsNothing = 0.01F * kPrior;

using Lanes = cv::v_int16x8;
using Patch = std::array<Lanes, kSide>;

/// All bits of what belongs to a row of a patch.
Lanes Inside() {
    return {-1, -1, -1, -1, -1, -1, -1, 0};
}

/// The lane beyond the patch, too.
Lanes Read(const std::uint8_t* row) {
    return cv::v_reinterpret_as_s16(cv::v_load_expand(row));
}

/// The patch that is searched, twice its slopes, and what they tell.
struct Template {
    Patch across;
    Patch down;
    Vector2f sum;    ///< of the slopes, once
    Vector2f pulls;  ///< sum of the slopes times the grey less its mean
    float deviation;
    Matrix2f information;
};

/// There are the patch, a pixel round it, and what else Blend reads.
bool Fits(const cv::Mat1b& picture, int x, int y) {
    constexpr int kMargin = kHalf + 1;
    return x >= kMargin && y >= kMargin && x + kMargin + 1 < picture.cols &&
           y + kMargin < picture.rows;
}

int Dot(const Patch& a, const Patch& b) {
    cv::v_int32x4 sum = cv::v_dotprod(a[0], b[0]);
    for (std::size_t i = 1; i < a.size(); ++i) sum = cv::v_dotprod(a[i], b[i], sum);
    return cv::v_reduce_sum(sum);
}

/// The sums of the columns fit into a lane.
int SumOf(const Patch& patch) {
    Lanes sum = patch[0];
    for (std::size_t i = 1; i < patch.size(); ++i) sum = sum + patch[i];
    return cv::v_reduce_sum(cv::v_dotprod(sum, cv::v_setall_s16(1)));
}

/// Times the root of the area, plus a little; `unit` is that of a grey level.
float DeviationOf(int sum, int squares, int unit) {
    const auto scale = static_cast<float>(kArea * unit * unit);
    const float spread = static_cast<float>(kArea) * static_cast<float>(squares) -
                         static_cast<float>(sum) * static_cast<float>(sum);
    return std::sqrt(std::max(0.0F, spread / scale) + 1);
}

/// The grey of the patch; writes twice its slopes.
Patch ReadSlopes(const cv::Mat1b& picture, int x, int y, Patch& across, Patch& down) {
    Patch grey;
    const Lanes inside = Inside();
    const auto pitch = static_cast<std::ptrdiff_t>(picture.step);
    const std::uint8_t* row = picture[y - kHalf] + x - kHalf;
    for (std::size_t i = 0; i < grey.size(); ++i, row += pitch) {
        grey[i] = Read(row) & inside;
        across[i] = (Read(row + 1) - Read(row - 1)) & inside;
        down[i] = (Read(row + pitch) - Read(row - pitch)) & inside;
    }
    return grey;
}

Template Cut(const cv::Mat1b& picture, int x, int y) {
    Template t;
    const Patch grey = ReadSlopes(picture, x, y, t.across, t.down);
    const int grey_sum = SumOf(grey);
    const auto half = [](int twice) { return 0.5F * static_cast<float>(twice); };
    t.sum = {half(SumOf(t.across)), half(SumOf(t.down))};
    const float xy = 0.5F * half(Dot(t.across, t.down));
    t.information << 0.5F * half(Dot(t.across, t.across)), xy, xy, 0.5F * half(Dot(t.down, t.down));
    t.pulls = Vector2f{half(Dot(grey, t.across)), half(Dot(grey, t.down))} -
              static_cast<float>(grey_sum) / kArea * t.sum;
    t.deviation = DeviationOf(grey_sum, Dot(grey, grey), 1);
    return t;
}

/// So many eighths of the way from eight times `a` to eight times `b`.
Lanes Mix(const Lanes& a, const Lanes& b, const Lanes& eighths) {
    return (a << 3) + cv::v_mul_wrap(b - a, eighths);
}

/// Bilinear, so many eighths of a pixel right of and below (x, y); in eighths of a grey level.
Patch Blend(const cv::Mat1b& picture, int x, int y, int right, int below) {
    Patch patch;
    const Lanes inside = Inside();
    const Lanes across = cv::v_setall_s16(static_cast<std::int16_t>(right));
    const Lanes down = cv::v_setall_s16(static_cast<std::int16_t>(below));
    const Lanes half = cv::v_setall_s16(kEighths / 2);
    const std::uint8_t* row = picture[y - kHalf] + x - kHalf;
    Lanes upper = Mix(Read(row), Read(row + 1), across);
    for (Lanes& lanes : patch) {
        row += static_cast<std::ptrdiff_t>(picture.step);
        const Lanes lower = Mix(Read(row), Read(row + 1), across);
        lanes = ((Mix(upper, lower, down) + half) >> 3) & inside;
        upper = lower;
    }
    return patch;
}

/// How the patch at a place pulls; false where it leaves the picture. The place is in eighths of a
/// pixel.
bool PullAt(const Template& t, const cv::Mat1b& to, const Eigen::Vector2i& place, Vector2f& pull) {
    const int x = place.x() >> 3;
    const int y = place.y() >> 3;
    if (!Fits(to, x, y)) return false;
    const Patch there = Blend(to, x, y, place.x() & 7, place.y() & 7);
    const int sum = SumOf(there);
    const float gain = t.deviation / DeviationOf(sum, Dot(there, there), kEighths);
    const Vector2f twice{static_cast<float>(Dot(there, t.across)),
                         static_cast<float>(Dot(there, t.down))};
    const Vector2f pulls =
        (0.5F * twice - static_cast<float>(sum) / kArea * t.sum) / static_cast<float>(kEighths);
    pull = t.pulls - gain * pulls;
    return true;
}

/// From the place nearest to the match, but with the prior at the match. False where the patch
/// leaves the picture.
bool Step(const Template& t, const Matrix2f& covariance, const cv::Mat1b& to, Vector2f& found_px,
          float& length_px) {
    const Eigen::Vector2i eighths = Round(kEighths * found_px);
    const Vector2f aside_px = found_px - eighths.cast<float>() / kEighths;
    Vector2f pull;
    if (!PullAt(t, to, eighths, pull)) return false;
    const Vector2f step = covariance * (pull + kPrior * aside_px) - aside_px;
    found_px += step.cwiseMin(1.0F).cwiseMax(-1.0F);
    length_px = step.norm();
    return true;
}

}  // namespace

HV_MULTIVERSION __attribute__((flatten)) float RefineMatch(const cv::Mat1b& from, int x, int y,
                                                           const cv::Mat1b& to,
                                                           Vector2f& found_px) {
    if (!Fits(from, x, y)) return 0;
    const Template t = Cut(from, x, y);
    const float told = t.information(0, 0) / (t.information(0, 0) + kPrior);
    if (t.information.trace() < kTellsNothing) return told;
    const Matrix2f covariance = (t.information + kPrior * Matrix2f::Identity()).inverse();
    Vector2f refined = found_px;
    float length_px = 2 * kNear_px;
    for (int step = 0; step < kSteps && length_px > kNear_px; ++step) {
        if (!Step(t, covariance, to, refined, length_px)) return 0;
    }
    if ((refined - found_px).norm() > kFarthest_px) return 0;
    found_px = refined;
    return told;
}

}  // namespace hitchview::algo
