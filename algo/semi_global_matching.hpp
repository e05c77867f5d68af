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

    /// The grid of this time: the first `cols` columns, 0..max_cols. All costs, greys and numbers
    /// of labels that are tried are to be written anew.
    void Start(int cols) { cols_ = cols; }
    /// How many labels of a node are tried, 1..labels, from the first on. It takes no other.
    std::uint8_t& tried(int row, int col) { return tried_[Node(row, col)]; }
    /// Costs of the labels of one node that are tried, 0..kDearest each.
    Cost* costs(int row, int col) { return costs_.data() + At(row, col); }
    /// What the node looks like: labels are thought to jump where it changes.
    std::uint8_t& grey(int row, int col) { return GreyOf(row)[col]; }
    /// Sums up along the paths.
    void Solve();

    struct Answer {
        int label = 0;
        float fraction = 0;  ///< of the minimum between labels, -0.5..0.5
        int lead = 0;        ///< summed cost of the best label that is no neighbour, less its own
    };
    /// After Solve.
    [[nodiscard]] Answer AnswerAt(int row, int col) const;

    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] int labels() const { return labels_; }

 private:
    [[nodiscard]] std::size_t Node(int row, int col) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(max_cols_) +
               static_cast<std::size_t>(col);
    }
    [[nodiscard]] std::size_t At(int row, int col) const {
        return Node(row, col) * static_cast<std::size_t>(labels_);
    }
    /// Of a row, which has one node more at either end.
    [[nodiscard]] std::uint8_t* GreyOf(int row) {
        return grey_.data() + static_cast<std::ptrdiff_t>(row) * (max_cols_ + 2) + 1;
    }
    /// The paths that end in a row, of the two kept at a time; likewise.
    [[nodiscard]] Cost* PathsOf(int line);
    void SweepFrom(int first_row, int down);

    int rows_;
    int max_cols_;
    int cols_ = 0;
    int labels_;
    SemiGlobalOptions options_;
    std::array<Cost, 256> jump_costs_;  // by difference of grey
    std::vector<std::uint8_t> grey_;
    std::vector<std::uint8_t> tried_;
    std::vector<Cost> costs_;
    std::vector<Sum> sums_;
    std::vector<Cost> paths_;
};

}  // namespace hitchview::algo
