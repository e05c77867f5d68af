#include "algo/scanline_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hitchview::algo {

ScanlineFit::ScanlineFit(int rows, int max_cols, const ScanlineFitOptions& options)
    : rows_(rows),
      max_cols_(max_cols),
      options_(options),
      cost_(Index(rows, 0)),
      heard_(Index(rows, 0)),
      price_(Index(1, 0)),
      from_(Index(1, 0)),
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
    std::array<float, kValues> wish{};
    for (int i = 0; i < rows_; ++i) {
        const std::size_t at = Index(down > 0 ? i : rows_ - 1 - i, col);
        for (std::size_t k = 0; k < kValues; ++k) {
            heard_[at + k] += wish[k];
            wish[k] += cost_[at + k];
        }
        const float least = *std::min_element(wish.begin(), wish.end());
        for (float& w : wish) w = std::min(w - least, most);
        for (std::size_t k = 1; k < kValues; ++k) wish[k] = std::min(wish[k], wish[k - 1] + step);
        for (std::size_t k = kValues - 1; k-- > 0;) wish[k] = std::min(wish[k], wish[k + 1] + step);
    }
}

void ScanlineFit::SolveRow(int row) {
    for (int col = 0; col < cols_; ++col) Reach(row, col);
    const float* end = price_.data() + Index(0, cols_ - 1);
    auto k = static_cast<int>(std::min_element(end, end + kValues) - end);
    for (int col = cols_ - 1; col >= 0; --col) {
        answer_[static_cast<std::size_t>(row * max_cols_ + col)] = static_cast<std::int8_t>(k);
        k += from_[Index(0, col) + static_cast<std::size_t>(k)];
    }
}

/// Prices of one node from those of the node before.
void ScanlineFit::Reach(int row, int col) {
    const auto change = static_cast<float>(options_.change_cost);
    for (int k = 0; k < kValues; ++k) {
        const auto at = static_cast<std::size_t>(k);
        float cheapest = col == 0 ? 0 : std::numeric_limits<float>::max();
        int best = 0;
        const int first = std::max(0, k - options_.most_steps);
        const int last = std::min(kValues - 1, k + options_.most_steps);
        for (int j = first; col > 0 && j <= last; ++j) {
            const float price = price_[Index(0, col - 1) + static_cast<std::size_t>(j)] +
                                change * static_cast<float>(std::abs(j - k));
            if (price >= cheapest) continue;
            cheapest = price;
            best = j - k;
        }
        price_[Index(0, col) + at] =
            cheapest + cost_[Index(row, col) + at] + heard_[Index(row, col) + at];
        from_[Index(0, col) + at] = static_cast<std::int8_t>(best);
    }
}

}  // namespace hitchview::algo
