#include "algo/scanline_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hitchview::algo {
namespace {

using Values = Eigen::Array<float, ScanlineFit::kValues, 1>;

/// Lets values be taken from neighbours at `step` each, for no more than `most`: at first from
/// those beside, then from ever farther ones.
void Spread(float step, float most, Values& wish) {
    constexpr int kMargin = ScanlineFit::kValues;
    std::array<float, ScanlineFit::kValues + 2 * kMargin> padded;
    padded.fill(most);
    const float* own = padded.data() + kMargin;
    int reach = 0;
    for (int away = 1; away < kMargin && static_cast<float>(reach) * step < most; away *= 2) {
        std::copy(wish.data(), wish.data() + wish.size(), padded.begin() + kMargin);
        wish = wish.min(
            Eigen::Map<const Values>(own - away).min(Eigen::Map<const Values>(own + away)) +
            step * static_cast<float>(away));
        reach += away;
    }
}

}  // namespace

ScanlineFit::ScanlineFit(int rows, int max_cols, const ScanlineFitOptions& options)
    : rows_(rows),
      max_cols_(max_cols),
      options_(options),
      cost_(Index(rows, 0)),
      heard_(Index(rows, 0)),
      price_(static_cast<std::size_t>(max_cols * (kValues + 2 * options.most_steps)),
             std::numeric_limits<float>::max()),
      answer_(static_cast<std::size_t>(rows * max_cols)) {}

void ScanlineFit::Start(int cols) {
    cols_ = cols;
    for (int row = 0; row < rows_; ++row) {
        const auto first = static_cast<std::ptrdiff_t>(Index(row, 0));
        const auto last = static_cast<std::ptrdiff_t>(Index(row, cols));
        std::fill(cost_.begin() + first, cost_.begin() + last, 0.0F);
        std::fill(heard_.begin() + first, heard_.begin() + last, 0.0F);
    }
}

void ScanlineFit::Vote(int row, int col, float value_px, float weight) {
    const auto step = static_cast<float>(options_.step_px);
    const float centre = (value_px - static_cast<float>(options_.lowest_px)) / step;
    const float reach = static_cast<float>(options_.tolerance_px) / step;
    const int first = std::max(0, static_cast<int>(std::ceil(centre - reach)));
    const int last = std::min(kValues - 1, static_cast<int>(std::floor(centre + reach)));
    float* cost = cost_.data() + Index(row, col);
    for (int k = first; k <= last; ++k)
        cost[k] -= weight * (1 - std::abs(static_cast<float>(k) - centre) / reach);
}

void ScanlineFit::Solve() {
    for (int col = 0; col < cols_; ++col) {
        Listen(col, 1);
        Listen(col, -1);
    }
    for (int row = 0; row < rows_; ++row) SolveRow(row);
}

/// Hands on, from row to row, what the rows before want; their wish fades with each change.
void ScanlineFit::Listen(int col, int down) {
    const auto most = static_cast<float>(options_.most_cost_down);
    const auto step = static_cast<float>(options_.change_cost_down);
    Values wish = Values::Zero();
    for (int i = 0; i < rows_; ++i) {
        const std::size_t at = Index(down > 0 ? i : rows_ - 1 - i, col);
        Eigen::Map<Values>(heard_.data() + at) += wish;
        wish += Eigen::Map<const Values>(cost_.data() + at);
        wish = (wish - wish.minCoeff()).cwiseMin(most);
        Spread(step, most, wish);
    }
}

void ScanlineFit::SolveRow(int row) {
    for (int col = 0; col < cols_; ++col) Reach(row, col);
    const float* end = price_.data() + PriceIndex(cols_ - 1);
    auto k = static_cast<int>(std::min_element(end, end + kValues) - end);
    for (int col = cols_ - 1; col >= 0; --col) {
        answer_[static_cast<std::size_t>(row * max_cols_ + col)] = static_cast<std::int8_t>(k);
        if (col > 0) k = Before(col, k);
    }
}

/// Prices of one node from those of the node before.
void ScanlineFit::Reach(int row, int col) {
    Eigen::Map<Values> price(price_.data() + PriceIndex(col));
    const std::size_t at = Index(row, col);
    const auto own =
        Eigen::Map<const Values>(cost_.data() + at) + Eigen::Map<const Values>(heard_.data() + at);
    if (col == 0) {
        price = own;
        return;
    }
    const float* before = price_.data() + PriceIndex(col - 1);
    Values cheapest = Eigen::Map<const Values>(before);
    for (int away = 1; away <= options_.most_steps; ++away) {
        cheapest = cheapest.min(
            Eigen::Map<const Values>(before - away).min(Eigen::Map<const Values>(before + away)) +
            static_cast<float>(options_.change_cost) * static_cast<float>(away));
    }
    price = cheapest + own;
}

/// The value of the node before `col` on the cheapest way to value `k`.
int ScanlineFit::Before(int col, int k) const {
    const float* before = price_.data() + PriceIndex(col - 1);
    const auto price = [&](int j) {
        return before[j] +
               static_cast<float>(options_.change_cost) * static_cast<float>(std::abs(j - k));
    };
    int best = std::max(0, k - options_.most_steps);
    const int last = std::min(kValues - 1, k + options_.most_steps);
    for (int j = best + 1; j <= last; ++j) {
        if (price(j) < price(best)) best = j;
    }
    return best;
}

}  // namespace hitchview::algo
