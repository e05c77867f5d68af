#include "algo/semi_global_matching.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

namespace hitchview::algo {
namespace {

using Cost = SemiGlobalMatching::Cost;
using Sum = SemiGlobalMatching::Sum;

/// Dearer than any path, which costs at most kDearest and a jump; one step more does not overflow.
constexpr Cost kNever = 240;

/// Of the labels from `first` to before `end`.
Sum Least(const Sum* sum, int first, int end) {
    Sum least = std::numeric_limits<Sum>::max();
    for (int k = first; k < end; ++k) least = std::min(least, sum[k]);
    return least;
}

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
      paths_(static_cast<std::size_t>(2 * (max_cols + 2) * kPaths * stride_)) {
    for (std::size_t edge = 0; edge < jump_costs_.size(); ++edge) {
        jump_costs_[edge] =
            std::max(options.least_jump_cost, options.jump_cost * options.edge_grey /
                                                  (options.edge_grey + static_cast<int>(edge)));
    }
}

void SemiGlobalMatching::Start(int cols) {
    cols_ = cols;
    for (int row = 0; row < rows_; ++row)
        std::fill(sums_.data() + At(row, 0), sums_.data() + At(row, cols), Sum{0});
}

void SemiGlobalMatching::Solve() {
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
               PathAt(from_row == row ? line : 1 - line, from_col, p), PathAt(line, col, p));
    }
    AddPaths(PathAt(line, col, 0), sums_.data() + at);
}

int SemiGlobalMatching::JumpCost(int row, int col, int from_row, int from_col) const {
    if (from_row < 0 || from_col < 0 || from_row >= rows_ || from_col >= cols_) return 0;
    const int edge = std::abs(int{grey_[Node(row, col)]} - int{grey_[Node(from_row, from_col)]});
    return jump_costs_[static_cast<std::size_t>(edge)];
}

/// To each label: its cost and the cheapest way from the node before, less the minimum there,
/// which only keeps the numbers small.
void SemiGlobalMatching::Extend(const Cost* __restrict cost, int jump_cost,
                                const Cost* __restrict before, Cost* __restrict path) const {
    const Cost least = before[labels_ + 1];
    const auto step = static_cast<Cost>(options_.step_cost);
    const auto jump = static_cast<Cost>(least + jump_cost);
    Cost lowest = kNever;
    for (int k = 0; k < labels_; ++k) {
        const auto beside = static_cast<Cost>(std::min(before[k - 1], before[k + 1]) + step);
        const Cost way = std::min(std::min(before[k], beside), jump);
        path[k] = static_cast<Cost>(cost[k] + way - least);
        lowest = std::min(lowest, path[k]);
    }
    path[-1] = path[labels_] = kNever;
    path[labels_ + 1] = lowest;
}

void SemiGlobalMatching::AddPaths(const Cost* __restrict first_path, Sum* __restrict sum) const {
    const Cost* second = first_path + stride_;
    const Cost* third = second + stride_;
    const Cost* fourth = third + stride_;
    for (int k = 0; k < labels_; ++k)
        sum[k] = static_cast<Sum>(sum[k] + first_path[k] + second[k] + third[k] + fourth[k]);
}

SemiGlobalMatching::Answer SemiGlobalMatching::AnswerAt(int row, int col) const {
    const Sum* sum = sums_.data() + At(row, col);
    const Sum* best = std::find(sum, sum + labels_, Least(sum, 0, labels_));
    Answer answer;
    answer.label = static_cast<int>(best - sum);
    answer.lead =
        std::min(Least(sum, 0, answer.label - 1), Least(sum, answer.label + 2, labels_)) - *best;
    if (answer.label == 0 || answer.label == labels_ - 1) return answer;
    const auto left = static_cast<float>(best[-1] - *best);
    const auto right = static_cast<float>(best[1] - *best);
    if (left + right > 0) answer.fraction = 0.5F * (left - right) / (left + right);
    return answer;
}

}  // namespace hitchview::algo
