#include <gtest/gtest.h>

#include "algo/label_reach.hpp"

namespace hitchview::algo {
namespace {

constexpr int kRows = 60;
constexpr int kCols = 200;
constexpr int kLabels = 96;

/// Every node takes `label`.
void NoteAll(LabelReach& reach, int label) {
    for (int row = 0; row < kRows; ++row) {
        for (int col = 0; col < kCols; ++col) reach.Note(row, col, label);
    }
}

/// Nodes where all labels are tried.
int Open(const LabelReach& reach) {
    int open = 0;
    for (int row = 0; row < kRows; ++row) {
        for (int col = 0; col < kCols; ++col) open += reach.At(row, col) == kLabels ? 1 : 0;
    }
    return open;
}

TEST(LabelReachTest, TriesAllLabelsWhereNothingIsKnown) {
    LabelReach reach(kRows, kCols, kLabels);
    reach.Start();
    EXPECT_EQ(Open(reach), kRows * kCols);
    NoteAll(reach, 5);
    reach.Start();
    EXPECT_LT(Open(reach), kRows * kCols / 3);
    reach.Reset();
    EXPECT_EQ(Open(reach), kRows * kCols);
}

TEST(LabelReachTest, TriesAllLabelsOfEachNodeOnceInATurn) {
    LabelReach reach(kRows, kCols, kLabels);
    std::vector<int> tried(kCols, 0);
    NoteAll(reach, 5);
    for (int frame = 0; frame < LabelReach::kBands; ++frame) {
        reach.Start();
        NoteAll(reach, 5);
        for (int col = 0; col < kCols; ++col)
            tried[static_cast<std::size_t>(col)] += reach.At(30, col) == kLabels ? 1 : 0;
    }
    for (const int times : tried) EXPECT_EQ(times, 1);
}

TEST(LabelReachTest, TriesHighLabelsRoundThingsThatTookThem) {
    LabelReach reach(kRows, kCols, kLabels);
    for (int frame = 0; frame < LabelReach::kBands; ++frame) {
        NoteAll(reach, 5);
        for (int row = 30; row < 33; ++row) reach.Note(row, 100, 70);
        reach.Start();
        for (const int away : {-8, 0, 8}) EXPECT_EQ(reach.At(31, 100 + away), kLabels);
    }
}

TEST(LabelReachTest, LeavesRoomAboveTheLabelsThatWereTaken) {
    LabelReach reach(kRows, kCols, kLabels);
    for (const int label : {0, 23, 24, 40, 60, 95}) {
        NoteAll(reach, label);
        reach.Start();
        for (int col = 0; col < kCols; ++col)
            EXPECT_GE(reach.At(10, col), std::min(label + 8, kLabels)) << label;
    }
}

}  // namespace
}  // namespace hitchview::algo
