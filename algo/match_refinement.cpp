#include "algo/match_refinement.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Matrix2f;
using Eigen::Vector2f;

constexpr int kHalf = 3;
constexpr int kSide = 2 * kHalf + 1;
constexpr int kArea = kSide * kSide;
constexpr int kSteps = 2;
constexpr float kFarthest_px = 2;
/// Variance of grey noise over that of the match.
constexpr float kPrior = 4.0F / (0.4F * 0.4F);

using Patch = std::array<float, kArea>;

/// The patch that is searched, its slopes, and what they tell.
struct Template {
    Patch grey;
    Patch across;
    Patch down;
    float deviation;
    Matrix2f information;
};

bool Fits(const cv::Mat1b& picture, int x, int y) {
    constexpr int kMargin = kHalf + 1;
    return x >= kMargin && y >= kMargin && x + kMargin < picture.cols && y + kMargin < picture.rows;
}

/// Takes the mean away; the deviation times the root of the area, plus a little.
float Level(Patch& patch) {
    float sum = 0;
    float squares = 0;
    for (const float grey : patch) {
        sum += grey;
        squares += grey * grey;
    }
    for (float& grey : patch) grey -= sum / kArea;
    return std::sqrt(std::max(0.0F, squares - sum * sum / kArea) + 1);
}

Template Cut(const cv::Mat1b& picture, int x, int y) {
    Template t;
    float xx = 0;
    float xy = 0;
    float yy = 0;
    std::size_t i = 0;
    for (int dy = -kHalf; dy <= kHalf; ++dy) {
        const std::uint8_t* row = picture[y + dy] + x - kHalf;
        const std::uint8_t* above = picture[y + dy - 1] + x - kHalf;
        const std::uint8_t* below = picture[y + dy + 1] + x - kHalf;
        for (int dx = 0; dx < kSide; ++dx, ++i) {
            t.grey[i] = row[dx];
            t.across[i] = 0.5F * static_cast<float>(row[dx + 1] - row[dx - 1]);
            t.down[i] = 0.5F * static_cast<float>(below[dx] - above[dx]);
            xx += t.across[i] * t.across[i];
            xy += t.across[i] * t.down[i];
            yy += t.down[i] * t.down[i];
        }
    }
    t.deviation = Level(t.grey);
    t.information << xx, xy, xy, yy;
    return t;
}

/// Bilinear.
Patch Read(const cv::Mat1b& picture, int x, int y, const Vector2f& fraction) {
    const float right = fraction.x();
    const float below = fraction.y();
    Patch patch;
    std::size_t i = 0;
    for (int dy = -kHalf; dy <= kHalf; ++dy) {
        const std::uint8_t* p = picture[y + dy] + x - kHalf;
        const std::uint8_t* q = picture[y + dy + 1] + x - kHalf;
        for (int dx = 0; dx < kSide; ++dx, ++i) {
            const auto top =
                static_cast<float>(p[dx]) + right * static_cast<float>(p[dx + 1] - p[dx]);
            const auto bottom =
                static_cast<float>(q[dx]) + right * static_cast<float>(q[dx + 1] - q[dx]);
            patch[i] = top + below * (bottom - top);
        }
    }
    return patch;
}

/// False where the patch leaves the picture.
bool Step(const Template& t, const cv::Mat1b& to, Vector2f& found_px) {
    const Vector2f whole = found_px.array().floor();
    const auto x = static_cast<int>(whole.x());
    const auto y = static_cast<int>(whole.y());
    if (!Fits(to, x, y)) return false;
    Patch there = Read(to, x, y, found_px - whole);
    const float gain = t.deviation / Level(there);
    Vector2f pull = Vector2f::Zero();
    for (std::size_t i = 0; i < kArea; ++i) {
        const float difference = t.grey[i] - gain * there[i];
        pull += difference * Vector2f{t.across[i], t.down[i]};
    }
    const Matrix2f normal = t.information + kPrior * Matrix2f::Identity();
    const Vector2f step = normal.inverse() * pull;
    found_px += step.cwiseMin(1.0F).cwiseMax(-1.0F);
    return true;
}

}  // namespace

float RefineMatch(const cv::Mat1b& from, int x, int y, const cv::Mat1b& to, Vector2f& found_px) {
    if (!Fits(from, x, y)) return 0;
    const Template t = Cut(from, x, y);
    Vector2f refined = found_px;
    for (int step = 0; step < kSteps; ++step) {
        if (!Step(t, to, refined)) return 0;
    }
    if ((refined - found_px).norm() > kFarthest_px) return 0;
    found_px = refined;
    return t.information(0, 0) / (t.information(0, 0) + kPrior);
}

}  // namespace hitchview::algo
