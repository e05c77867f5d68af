#include "algo/semi_global_matching.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

using Answer = SemiGlobalMatching::Answer;
using Cost = SemiGlobalMatching::Cost;
using Sum = SemiGlobalMatching::Sum;

/// Labels are searched in blocks of so many.
constexpr int kBlock = 16;
/// Dearer than any path, which costs at most kDearest and a jump; one step more does not overflow.
constexpr Cost kNever = 240;
constexpr Sum kNeverSum = std::numeric_limits<Sum>::max();

constexpr int kPaths = 4;  // in each of two directions

/// A path's costs at a node stand between the least of them and one that nobody takes before, and
/// as many that nobody takes as fill a block behind.
constexpr int kBefore = 2;
constexpr int PathStride(int labels) {
    return kBefore + (labels / kBlock + 1) * kBlock;
}

/// The way to a node from the one before on a path.
struct Way {
    const Cost* before;  ///< costs of the labels there, see PathStride
    int jump_cost;
};

/// A row of nodes; each pointer is to the node at its left end.
struct Line {
    const std::uint8_t* tried;
    const Cost* costs;
    Sum* sums;
    const std::uint8_t* grey;
    const std::uint8_t* grey_before;  ///< of the row that was swept before
    Cost* paths;                      ///< kPaths of each node; beyond the border of cost 0
    const Cost* paths_before;
};

/// What is alike at all nodes.
struct Terms {
    int cols;
    int labels;
    int down;  ///< 1: from the top and the left, -1: from the bottom and the right
    Cost step;
    const Cost* jumps;  ///< by difference of grey
};

/// The labels of one node.
struct Own {
    const Cost* costs;
    int tried;
    int labels;
};

/// Cost of label `k` by way of the node before, less the minimum there, which only keeps the
/// numbers small.
inline Cost Extended(const Cost* before, Cost least, Cost jump, Cost own, Cost step, int k) {
    const auto beside = static_cast<Cost>(std::min(before[k - 1], before[k + 1]) + step);
    const Cost cheapest = std::min(std::min(before[k], beside), jump);
    return static_cast<Cost>(own + cheapest - least);
}

/// What is not tried costs more than any path.
inline void Close(const Own& own, Cost least, Cost* path) {
    path[-2] = least;
    path[-1] = kNever;
    int k = own.tried;
    for (; k % kBlock != 0; ++k) path[k] = kNever;
    for (; k <= own.labels; k += kBlock) std::memset(path + k, kNever, kBlock);
}

/// Extends two paths to a node and adds them to its sums; `kept`: the bits of those that count.
HV_MULTIVERSION
void ExtendTwo(const Own& own, const Way& a, const Way& b, Cost step, Cost* __restrict to_a,
               Cost* __restrict to_b, Sum kept, Sum* __restrict sum) {
    const Cost* __restrict cost = own.costs;
    const int tried = own.tried;
    const Cost* __restrict before_a = a.before;
    const Cost* __restrict before_b = b.before;
    const Cost least_a = before_a[-2];
    const Cost least_b = before_b[-2];
    const auto jump_a = static_cast<Cost>(least_a + a.jump_cost);
    const auto jump_b = static_cast<Cost>(least_b + b.jump_cost);
    Cost lowest_a = kNever;
    Cost lowest_b = kNever;
    for (int k = 0; k < tried; ++k) {
        const Cost at_a = Extended(before_a, least_a, jump_a, cost[k], step, k);
        const Cost at_b = Extended(before_b, least_b, jump_b, cost[k], step, k);
        to_a[k] = at_a;
        to_b[k] = at_b;
        lowest_a = std::min(lowest_a, at_a);
        lowest_b = std::min(lowest_b, at_b);
        sum[k] = static_cast<Sum>((sum[k] & kept) + at_a + at_b);
    }
    Close(own, lowest_a, to_a);
    Close(own, lowest_b, to_b);
}

void VisitNode(const Line& line, const Terms& terms, int col) {
    const int stride = PathStride(terms.labels);
    const auto way = [&](const Cost* paths, const std::uint8_t* grey, int from, int path) {
        const Cost* before = paths + (from * kPaths + path) * stride;
        const int edge = std::abs(int{line.grey[col]} - int{grey[from]});
        return Way{before, terms.jumps[edge]};
    };
    const auto above = [&](int from, int path) {
        return way(line.paths_before, line.grey_before, from, path);
    };
    const Own own{line.costs + col * terms.labels, line.tried[col], terms.labels};
    Sum* sum = line.sums + col * terms.labels;
    Cost* to = line.paths + col * kPaths * stride;
    constexpr Sum kAll = -1;
    const Sum kept = terms.down > 0 ? Sum{0} : kAll;  // the first sweep begins anew
    ExtendTwo(own, way(line.paths, line.grey, col - terms.down, 0), above(col - 1, 1), terms.step,
              to, to + stride, kept, sum);
    ExtendTwo(own, above(col, 2), above(col + 1, 3), terms.step, to + 2 * stride, to + 3 * stride,
              kAll, sum);
}

/// Paths from the row before and from one side.
void SweepRow(const Line& line, const Terms& terms) {
    for (int j = 0; j < terms.cols; ++j)
        VisitNode(line, terms, terms.down > 0 ? j : terms.cols - 1 - j);
}

inline Sum Least(const Sum* sum, int labels) {
    Sum least = kNeverSum;
    for (int k = 0; k < labels; ++k) least = std::min(least, sum[k]);
    return least;
}

/// The first of the labels with this sum, which is there.
inline int Find(const Sum* sum, int labels, Sum wanted) {
    int block = 0;
    while (block + kBlock < labels && Least(sum + block, kBlock) != wanted) block += kBlock;
    while (sum[block] != wanted) ++block;
    return block;
}

/// Of the minimum between labels; the best is at neither end.
inline float FractionAt(const Sum* best) {
    const auto left = static_cast<float>(best[-1] - *best);
    const auto right = static_cast<float>(best[1] - *best);
    return left + right > 0 ? 0.5F * (left - right) / (left + right) : 0;
}

/// From complete sums.
HV_MULTIVERSION
Answer AnswerFrom(const Sum* sum, int labels) {
    Answer answer;
    const Sum least = Least(sum, labels);
    answer.label = Find(sum, labels, least);
    const int after = std::min(labels, answer.label + 2);
    const Sum rival = std::min(Least(sum, answer.label - 1), Least(sum + after, labels - after));
    answer.lead = rival - least;
    if (answer.label > 0 && answer.label + 1 < labels)
        answer.fraction = FractionAt(sum + answer.label);
    return answer;
}

}  // namespace

SemiGlobalMatching::SemiGlobalMatching(int rows, int max_cols, int labels,
                                       const SemiGlobalOptions& options)
    : rows_(rows),
      max_cols_(max_cols),
      labels_(labels),
      options_(options),
      grey_(static_cast<std::size_t>(rows * (max_cols + 2))),
      tried_(Node(rows, 0), static_cast<std::uint8_t>(labels)),
      costs_(At(rows, 0)),
      sums_(At(rows, 0)),
      paths_(static_cast<std::size_t>(2 * (max_cols + 2) * kPaths * PathStride(labels))) {
    for (std::size_t edge = 0; edge < jump_costs_.size(); ++edge) {
        const int cost =
            options.jump_cost * options.edge_grey / (options.edge_grey + static_cast<int>(edge));
        jump_costs_[edge] = static_cast<Cost>(std::max(options.least_jump_cost, cost));
    }
}

void SemiGlobalMatching::Solve() {
    SweepFrom(0, 1);
    SweepFrom(rows_ - 1, -1);
}

SemiGlobalMatching::Answer SemiGlobalMatching::AnswerAt(int row, int col) const {
    return AnswerFrom(sums_.data() + At(row, col), tried_[Node(row, col)]);
}

SemiGlobalMatching::Cost* SemiGlobalMatching::PathsOf(int line) {
    const int first = (line * (max_cols_ + 2) + 1) * kPaths;
    return paths_.data() + static_cast<std::ptrdiff_t>(first) * PathStride(labels_) + kBefore;
}

void SemiGlobalMatching::SweepFrom(int first_row, int down) {
    std::fill(paths_.begin(), paths_.end(), Cost{0});  // beyond the border every label is free
    const Terms terms{cols_, labels_, down, static_cast<Cost>(options_.step_cost),
                      jump_costs_.data()};
    for (int i = 0; i < rows_; ++i) {
        const int row = first_row + i * down;
        const Line line{&tried(row, 0),
                        costs(row, 0),
                        sums_.data() + At(row, 0),
                        GreyOf(row),
                        GreyOf(i > 0 ? row - down : row),
                        PathsOf(i % 2),
                        PathsOf(1 - i % 2)};
        SweepRow(line, terms);
    }
}

}  // namespace hitchview::algo
