#include "algo/semi_global_matching.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace hitchview::algo {
namespace {

/// Dearer than any path, and far from overflow.
constexpr SemiGlobalMatching::Cost kNever = 8000;

}  // namespace

SemiGlobalMatching::SemiGlobalMatching(int rows, int max_cols, int labels,
                                       const SemiGlobalOptions& options)
    : rows_(rows),
      max_cols_(max_cols),
      labels_(labels),
      stride_(labels + 3),
      options_(options),
      grey_(Node(rows, 0)),
      costs_(At(rows, 0)),
      sums_(At(rows, 0)),
      paths_(static_cast<std::size_t>(2 * (max_cols + 2) * kPaths * stride_)) {}

void SemiGlobalMatching::Solve() {
    std::fill(sums_.begin(), sums_.end(), Cost{0});
    SweepFrom(0, 1);
    SweepFrom(rows_ - 1, -1);
}

/// Paths from the row before and from one side.
void SemiGlobalMatching::SweepFrom(int first_row, int down) {
    std::fill(paths_.begin(), paths_.end(), Cost{0});  // beyond the border every label is free
    for (int i = 0; i < rows_; ++i) {
        for (int j = 0; j < cols_; ++j)
            Visit(first_row + i * down, down > 0 ? j : cols_ - 1 - j, down, i % 2);
    }
}

void SemiGlobalMatching::Visit(int row, int col, int down, int line) {
    const std::array<std::array<int, 2>, kPaths> before{
        {{row, col - down}, {row - down, col - 1}, {row - down, col}, {row - down, col + 1}}};
    const std::size_t at = At(row, col);
    for (int p = 0; p < kPaths; ++p) {
        const auto& [from_row, from_col] = before[static_cast<std::size_t>(p)];
        Extend(costs_.data() + at, JumpCost(row, col, from_row, from_col),
               PathAt(from_row == row ? line : 1 - line, from_col, p), PathAt(line, col, p),
               sums_.data() + at);
    }
}

int SemiGlobalMatching::JumpCost(int row, int col, int from_row, int from_col) const {
    if (from_row < 0 || from_col < 0 || from_row >= rows_ || from_col >= cols_) return 0;
    const int edge = std::abs(int{grey_[Node(row, col)]} - int{grey_[Node(from_row, from_col)]});
    return std::max(options_.least_jump_cost,
                    options_.jump_cost * options_.edge_grey / (options_.edge_grey + edge));
}

/// To each label: its cost and the cheapest way from the node before, less the minimum there,
/// which only keeps the numbers small.
void SemiGlobalMatching::Extend(const Cost* cost, int jump_cost, const Cost* before, Cost* path,
                                Cost* sum) const {
    const Cost least = before[labels_ + 1];
    const auto step = static_cast<Cost>(options_.step_cost);
    const auto jump = static_cast<Cost>(least + jump_cost);
    Cost lowest = kNever;
    for (int k = 0; k < labels_; ++k) {
        const auto beside = static_cast<Cost>(std::min(before[k - 1], before[k + 1]) + step);
        const Cost way = std::min(std::min(before[k], beside), jump);
        const auto value = static_cast<Cost>(cost[k] + way - least);
        path[k] = value;
        sum[k] = static_cast<Cost>(sum[k] + value);
        lowest = std::min(lowest, value);
    }
    path[-1] = path[labels_] = kNever;
    path[labels_ + 1] = lowest;
}

SemiGlobalMatching::Answer SemiGlobalMatching::AnswerAt(int row, int col) const {
    const Cost* sum = sums_.data() + At(row, col);
    const Cost* best = std::min_element(sum, sum + labels_);
    Answer answer;
    answer.label = static_cast<int>(best - sum);
    Cost second = kNever;
    for (int k = 0; k < labels_; ++k) {
        if (std::abs(k - answer.label) > 1) second = std::min(second, sum[k]);
    }
    answer.lead = second - *best;
    if (answer.label == 0 || answer.label == labels_ - 1) return answer;
    const auto left = static_cast<float>(best[-1] - *best);
    const auto right = static_cast<float>(best[1] - *best);
    if (left + right > 0) answer.fraction = 0.5F * (left - right) / (left + right);
    return answer;
}

}  // namespace hitchview::algo
