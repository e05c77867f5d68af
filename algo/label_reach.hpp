#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace hitchview::algo {

/// How many of a node's labels, from the first on, are worth trying: things that take high labels
/// are few and stay near where they were. All labels are tried near those, where nothing is known
/// and, in turns, in one of kBands bands of columns: what appears is missed for no longer. Memory
/// is taken at construction; not thread-safe.
class LabelReach {
 public:
    static constexpr int kBands = 5;
    static constexpr int kBlock = 32;  ///< labels are tried in blocks of so many

    LabelReach(int rows, int cols, int labels);

    /// Begins a frame: from now on At follows from what was noted since the Start before.
    void Start();
    [[nodiscard]] int At(int row, int col) const {
        return (turn_ + col / band_cols_) % kBands == 0 ? labels_ : reach_[Cell(row, col)];
    }
    /// The label that a node took.
    void Note(int row, int col, int label);
    void Reset();

 private:
    static constexpr int kCellRows = 6;  // nodes
    static constexpr int kCellCols = 8;
    /// How many nodes of a cell took a label of each block, or one just before it.
    static constexpr int kMaxBlocks = 8;
    using Counts = std::array<std::uint8_t, kMaxBlocks>;

    [[nodiscard]] std::size_t Cell(int row, int col) const {
        return static_cast<std::size_t>(row / kCellRows * cell_cols_ + col / kCellCols);
    }
    [[nodiscard]] int ReachOf(const Counts& counts) const;
    [[nodiscard]] int ReachAround(int cell_row, int cell_col) const;

    int labels_;
    int band_cols_;
    int cell_rows_;
    int cell_cols_;
    int turn_ = 0;
    std::vector<Counts> counts_;
    std::vector<int> alone_;  // reach of each cell by what was found there
    std::vector<int> reach_;  // and round it
};

}  // namespace hitchview::algo
