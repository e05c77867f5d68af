#include "algo/match_refinement.hpp"

#include <Eigen/LU>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Matrix2f;
using Eigen::Vector2f;

constexpr int kHalf = 3;
constexpr int kSide = 2 * kHalf + 1;
constexpr int kArea = kSide * kSide;
constexpr int kLanes = 8;  // of a row: one more than a patch has, which is 0
constexpr int kSteps = 2;
constexpr float kFarthest_px = 2;
/// Variance of grey noise over that of the match.
constexpr float kPrior = 4.0F / (0.4F * 0.4F);

/// Column i is row i of the picture.
template <int rows>
using Rows = Eigen::Array<float, kLanes, rows>;
using Patch = Rows<kSide>;

/// 0 in the last lane.
const Patch kInside = [] {
    Patch inside = Patch::Ones();
    inside.row(kSide).setZero();
    return inside;
}();

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

template <int rows>
Rows<rows> Read(const cv::Mat1b& picture, int x, int y) {
    Rows<rows> read;
    for (int i = 0; i < rows; ++i) {
        const std::uint8_t* row = picture[y + i] + x;
        for (int lane = 0; lane < kLanes; ++lane) read(lane, i) = row[lane];
    }
    return read;
}

/// The pixels to the right of `rows`; the last lane is of no meaning.
Patch ToTheRight(const Rows<kSide + 1>& rows) {
    return Eigen::Map<const Patch, Eigen::Unaligned>(rows.data() + 1);
}

/// Takes the mean away; the deviation times the root of the area, plus a little.
float Level(Patch& patch) {
    patch *= kInside;
    const float sum = patch.sum();
    const float squares = patch.square().sum();
    patch -= sum / kArea;
    return std::sqrt(std::max(0.0F, squares - sum * sum / kArea) + 1);
}

Template Cut(const cv::Mat1b& picture, int x, int y) {
    Template t;
    const int left = x - kHalf;
    const int top = y - kHalf;
    const auto tall = Read<kSide + 2>(picture, left, top - 1);
    t.grey = tall.middleCols<kSide>(1);
    t.down = 0.5F * kInside * (tall.rightCols<kSide>() - tall.leftCols<kSide>());
    t.across = 0.5F * kInside *
               (Read<kSide>(picture, left + 1, top) - Read<kSide>(picture, left - 1, top));
    const float xy = (t.across * t.down).sum();
    t.information << t.across.square().sum(), xy, xy, t.down.square().sum();
    t.deviation = Level(t.grey);
    return t;
}

/// Bilinear.
Patch ReadBetween(const cv::Mat1b& picture, int x, int y, const Vector2f& fraction) {
    Rows<kSide + 1> rows = Read<kSide + 1>(picture, x - kHalf, y - kHalf);
    rows.leftCols<kSide>() += fraction.y() * (rows.rightCols<kSide>() - rows.leftCols<kSide>());
    return rows.leftCols<kSide>() + fraction.x() * (ToTheRight(rows) - rows.leftCols<kSide>());
}

/// False where the patch leaves the picture.
bool Step(const Template& t, const Matrix2f& covariance, const cv::Mat1b& to, Vector2f& found_px) {
    const Vector2f whole = found_px.array().floor();
    const auto x = static_cast<int>(whole.x());
    const auto y = static_cast<int>(whole.y());
    if (!Fits(to, x, y)) return false;
    Patch there = ReadBetween(to, x, y, found_px - whole);
    const float gain = t.deviation / Level(there);
    there = t.grey - gain * there;
    const Vector2f pull{(there * t.across).sum(), (there * t.down).sum()};
    found_px += (covariance * pull).cwiseMin(1.0F).cwiseMax(-1.0F);
    return true;
}

}  // namespace

float RefineMatch(const cv::Mat1b& from, int x, int y, const cv::Mat1b& to, Vector2f& found_px) {
    if (!Fits(from, x, y)) return 0;
    const Template t = Cut(from, x, y);
    const Matrix2f covariance = (t.information + kPrior * Matrix2f::Identity()).inverse();
    Vector2f refined = found_px;
    for (int step = 0; step < kSteps; ++step) {
        if (!Step(t, covariance, to, refined)) return 0;
    }
    if ((refined - found_px).norm() > kFarthest_px) return 0;
    found_px = refined;
    return t.information(0, 0) / (t.information(0, 0) + kPrior);
}

}  // namespace hitchview::algo
