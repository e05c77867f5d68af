#include "algo/label_reach.hpp"

#include <algorithm>

namespace hitchview::algo {
namespace {

constexpr int kMargin = 8;    // a node may take a label this much higher in the next frame
constexpr int kFewNodes = 2;  // fewer that agree are taken to be wrong

int PartsOf(int length, int part) {
    return (length + part - 1) / part;
}

}  // namespace

LabelReach::LabelReach(int rows, int cols, int labels)
    : labels_(labels),
      band_cols_(PartsOf(cols, 2 * kBands)),
      cell_rows_(PartsOf(rows, kCellRows)),
      cell_cols_(PartsOf(cols, kCellCols)),
      counts_(static_cast<std::size_t>(cell_rows_ * cell_cols_)),
      alone_(counts_.size()),
      reach_(counts_.size()) {
    Reset();
}

void LabelReach::Reset() {
    turn_ = 0;
    std::fill(counts_.begin(), counts_.end(), Counts{});
    std::fill(reach_.begin(), reach_.end(), labels_);
}

void LabelReach::Start() {
    turn_ = (turn_ + 1) % kBands;
    std::transform(counts_.begin(), counts_.end(), alone_.begin(),
                   [&](const Counts& counts) { return ReachOf(counts); });
    std::fill(counts_.begin(), counts_.end(), Counts{});
    for (int row = 0; row < cell_rows_; ++row) {
        for (int col = 0; col < cell_cols_; ++col)
            reach_[static_cast<std::size_t>(row * cell_cols_ + col)] = ReachAround(row, col);
    }
}

void LabelReach::Note(int row, int col, int label) {
    const int block = std::min((label + kMargin) / kBlock, kMaxBlocks - 1);
    ++counts_[Cell(row, col)][static_cast<std::size_t>(block)];
}

int LabelReach::ReachOf(const Counts& counts) const {
    int nodes = 0;
    for (int block = kMaxBlocks - 1; block >= 0; --block) {
        nodes += counts[static_cast<std::size_t>(block)];
        if (nodes >= kFewNodes) return std::min(labels_, (block + 1) * kBlock);
    }
    return labels_;
}

int LabelReach::ReachAround(int cell_row, int cell_col) const {
    int reach = 0;
    for (int row = std::max(0, cell_row - 1); row <= std::min(cell_rows_ - 1, cell_row + 1);
         ++row) {
        for (int col = std::max(0, cell_col - 1); col <= std::min(cell_cols_ - 1, cell_col + 1);
             ++col)
            reach = std::max(reach, alone_[static_cast<std::size_t>(row * cell_cols_ + col)]);
    }
    return reach;
}

}  // namespace hitchview::algo
