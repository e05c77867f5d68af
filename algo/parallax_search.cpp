#include "algo/parallax_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

constexpr int kHalf = 5;
constexpr int kSide = 2 * kHalf + 1;
constexpr int kArea = kSide * kSide;
constexpr int kMaxSteps = 96;

struct Place {
    int x;
    int y;
};

Place Nearest(const Vector2f& pixel) {
    return {static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
}

bool Fits(const cv::Mat1b& picture, const Place& p) {
    return p.x >= kHalf && p.y >= kHalf && p.x + kHalf < picture.cols && p.y + kHalf < picture.rows;
}

/// A patch with zero mean, and its norm.
struct Template {
    std::array<int, kArea> grey;  // kArea times the difference to the mean
    float norm;
};

Template Cut(const cv::Mat1b& picture, const Place& p) {
    Template t{};
    int sum = 0;
    for (int y = 0; y < kSide; ++y) {
        const std::uint8_t* row = picture[p.y - kHalf + y] + p.x - kHalf;
        for (int x = 0; x < kSide; ++x) {
            t.grey[static_cast<std::size_t>(y * kSide + x)] = row[x];
            sum += row[x];
        }
    }
    double squares = 0;
    for (int& g : t.grey) {
        g = kArea * g - sum;
        squares += static_cast<double>(g) * g;
    }
    t.norm = static_cast<float>(std::sqrt(squares)) / kArea;
    return t;
}

float Correlation(const Template& t, const cv::Mat1b& picture, const Place& p) {
    std::int64_t product = 0;
    int sum = 0;
    int squares = 0;
    for (int y = 0; y < kSide; ++y) {
        const std::uint8_t* row = picture[p.y - kHalf + y] + p.x - kHalf;
        const int* grey = t.grey.data() + y * kSide;
        int line = 0;
        for (int x = 0; x < kSide; ++x) {
            line += grey[x] * row[x];
            sum += row[x];
            squares += row[x] * row[x];
        }
        product += line;
    }
    const float variance =
        static_cast<float>(squares) - static_cast<float>(sum) * static_cast<float>(sum) / kArea;
    return static_cast<float>(product) / kArea /
           std::max(1e-3F, t.norm * std::sqrt(std::max(0.0F, variance)));
}

}  // namespace

std::optional<Vector2f> SearchAlongRow(const cv::Mat1b& from, const cv::Mat1b& to,
                                       const Vector2f& at_px, const Vector2f& base_px,
                                       const Vector2f& expected_px, const ParallaxRange& range,
                                       const ParallaxSearchOptions& options) {
    const Place at = Nearest(at_px);
    if (!Fits(from, at)) return std::nullopt;
    const Template t = Cut(from, at);
    if (t.norm < options.min_deviation * kSide) return std::nullopt;

    const Vector2f low = base_px + Vector2f{std::min(range.from_px, range.to_px), 0};
    const int steps =
        std::min(kMaxSteps, 1 + static_cast<int>(std::abs(range.to_px - range.from_px)));
    std::array<float, kMaxSteps> score;
    int best = -1;
    for (int i = 0; i < steps; ++i) {
        const auto k = static_cast<std::size_t>(i);
        Place p = Nearest(low);
        p.x += i;
        score[k] = Fits(to, p) ? Correlation(t, to, p) : -1;
        const float x = low.x() + static_cast<float>(i);
        if (std::abs(x - expected_px.x()) < options.habit_px) score[k] += options.habit;
        if (best < 0 || score[k] > score[static_cast<std::size_t>(best)]) best = i;
    }
    const float top = score[static_cast<std::size_t>(best)];
    if (top < options.min_correlation) return std::nullopt;
    constexpr int kNeighbourhood = 3;
    for (int i = 0; i < steps; ++i) {
        if (std::abs(i - best) > kNeighbourhood &&
            score[static_cast<std::size_t>(i)] > top - options.min_lead) {
            return std::nullopt;
        }
    }
    return at_px - Vector2f{static_cast<float>(at.x), static_cast<float>(at.y)} +
           Vector2f{static_cast<float>(Nearest(low).x + best), static_cast<float>(Nearest(low).y)};
}

}  // namespace hitchview::algo
