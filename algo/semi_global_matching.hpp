#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace hitchview::algo {

struct SemiGlobalOptions {
    int step_cost = 10;        ///< of a neighbour one label away, 0..15
    int jump_cost = 100;       ///< of a neighbour any farther away that looks alike, up to 170
    int least_jump_cost = 30;  ///< of one that looks different
    int edge_grey = 15;        ///< difference of grey that halves the cost of a jump
};

/// Gives each node of a grid one of `labels` ordered labels: cheap in itself, and like its
/// neighbours'. Costs are summed along straight paths from eight sides (semi-global matching;
/// Hirschmueller, PAMI 2008). Memory is taken at construction; not thread-safe.
class SemiGlobalMatching {
 public:
    using Cost = std::uint8_t;            ///< small, so that many are handled at once
    using Sum = std::int16_t;             ///< of the costs of all paths
    static constexpr Cost kDearest = 64;  ///< for one node

    SemiGlobalMatching(int rows, int max_cols, int labels, const SemiGlobalOptions& options);

    /// The grid of this time: the first `cols` columns, 0..max_cols. All costs and greys are to be
    /// written anew.
    void Start(int cols);
    /// Costs of the labels of one node, 0..kDearest each.
    Cost* costs(int row, int col) { return costs_.data() + At(row, col); }
    /// What the node looks like: labels are thought to jump where it changes.
    std::uint8_t& grey(int row, int col) { return grey_[Node(row, col)]; }
    /// Sums up along the paths.
    void Solve();

    struct Answer {
        int label = 0;
        float fraction = 0;  ///< of the minimum between labels, -0.5..0.5
        int lead = 0;        ///< summed cost of the best label that is no neighbour, less its own
    };
    [[nodiscard]] Answer AnswerAt(int row, int col) const;

    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] int labels() const { return labels_; }

 private:
    static constexpr int kPaths = 4;  // in each of two directions

    [[nodiscard]] std::size_t Node(int row, int col) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(max_cols_) +
               static_cast<std::size_t>(col);
    }
    [[nodiscard]] std::size_t At(int row, int col) const {
        return Node(row, col) * static_cast<std::size_t>(labels_);
    }
    void SweepFrom(int first_row, int down);
    void Visit(int row, int col, int down, int line);
    void Extend(const Cost* cost, int jump_cost, const Cost* before, Cost* path) const;
    void AddPaths(const Cost* first_path, Sum* sum) const;
    [[nodiscard]] int JumpCost(int row, int col, int from_row, int from_col) const;
    /// The path that ends at column `col`, -1..cols, of the newest line or the one before.
    [[nodiscard]] Cost* PathAt(int line, int col, int path) {
        const int at = ((line * (max_cols_ + 2)) + col + 1) * kPaths + path;
        return paths_.data() + static_cast<std::ptrdiff_t>(at) * stride_ + 1;
    }

    int rows_;
    int max_cols_;
    int cols_ = 0;
    int labels_;
    int stride_;  // of one path: the labels between two that nobody takes, and their minimum
    SemiGlobalOptions options_;
    std::array<int, 256> jump_costs_;  // by difference of grey
    std::vector<std::uint8_t> grey_;
    std::vector<Cost> costs_;
    std::vector<Sum> sums_;
    std::vector<Cost> paths_;  // of two lines of nodes
};

}  // namespace hitchview::algo
