#include <gtest/gtest.h>

#include <array>
#include <climits>
#include <cstdlib>
#include <opencv2/core.hpp>

#include "algo/semi_global_matching.hpp"

namespace hitchview::algo {
namespace {

using Cost = SemiGlobalMatching::Cost;

/// Costs and greys at random, and what the answers are by trying every labelling of every path.
class RandomGrid {
 public:
    RandomGrid(int rows, int cols, int labels, std::uint64_t seed)
        : rows_(rows), cols_(cols), labels_(labels) {
        cv::RNG random(seed);
        for (int i = 0; i < rows * cols; ++i) {
            grey_.push_back(random.uniform(0, 256));
            for (int k = 0; k < labels; ++k)
                cost_.push_back(random.uniform(0, SemiGlobalMatching::kDearest + 1));
        }
    }

    void WriteTo(SemiGlobalMatching& matching) const {
        for (int row = 0; row < rows_; ++row) {
            for (int col = 0; col < cols_; ++col) {
                matching.grey(row, col) = static_cast<std::uint8_t>(GreyAt(row, col));
                for (int k = 0; k < labels_; ++k)
                    matching.costs(row, col)[k] = static_cast<Cost>(CostOf(row, col, k));
            }
        }
    }

    /// Of all eight paths that end at the node; each up to a constant.
    [[nodiscard]] int SumAt(int row, int col, int label) const {
        int sum = 0;
        for (const int down : {-1, 0, 1}) {
            for (const int across : {-1, 0, 1}) {
                if (down != 0 || across != 0) sum += Path(row, col, label, down, across);
            }
        }
        return sum;
    }
    [[nodiscard]] std::vector<int> SumsAt(int row, int col) const {
        std::vector<int> sums;
        for (int k = 0; k < labels_; ++k) sums.push_back(SumAt(row, col, k));
        return sums;
    }

 private:
    [[nodiscard]] std::size_t Node(int row, int col) const {
        return static_cast<std::size_t>(row * cols_ + col);
    }
    [[nodiscard]] int GreyAt(int row, int col) const { return grey_[Node(row, col)]; }
    [[nodiscard]] int CostOf(int row, int col, int label) const {
        return cost_[Node(row, col) * static_cast<std::size_t>(labels_) +
                     static_cast<std::size_t>(label)];
    }
    static int ChangeCost(int change, int edge) {
        const SemiGlobalOptions o;
        if (change == 0) return 0;
        const int jump =
            std::max(o.least_jump_cost, o.jump_cost * o.edge_grey / (o.edge_grey + edge));
        return change == 1 ? std::min(o.step_cost, jump) : jump;
    }
    /// Cheapest of all labellings of the straight path that ends here with `label`.
    [[nodiscard]] int Path(int row, int col, int label, int down, int across) const {
        const int r = row - down;
        const int c = col - across;
        const int here = CostOf(row, col, label);
        if (r < 0 || c < 0 || r >= rows_ || c >= cols_) return here;
        int least = INT_MAX;
        for (int k = 0; k < labels_; ++k) {
            const int edge = std::abs(GreyAt(row, col) - GreyAt(r, c));
            least = std::min(least,
                             Path(r, c, k, down, across) + ChangeCost(std::abs(k - label), edge));
        }
        return here + least;
    }

    int rows_;
    int cols_;
    int labels_;
    std::vector<int> grey_;
    std::vector<int> cost_;
};

/// Sum of the cheapest label that is no neighbour of `label`.
int RivalOf(const std::vector<int>& sums, int label) {
    int rival = INT_MAX;
    for (int k = 0; k < static_cast<int>(sums.size()); ++k) {
        if (std::abs(k - label) > 1) rival = std::min(rival, sums[static_cast<std::size_t>(k)]);
    }
    return rival;
}

void ExpectCheapest(const SemiGlobalMatching& matching, const RandomGrid& grid) {
    for (int row = 0; row < matching.rows(); ++row) {
        for (int col = 0; col < matching.cols(); ++col) {
            const std::vector<int> sums = grid.SumsAt(row, col);
            const SemiGlobalMatching::Answer answer = matching.AnswerAt(row, col);
            const int least = *std::min_element(sums.begin(), sums.end());
            EXPECT_EQ(sums[static_cast<std::size_t>(answer.label)], least) << row << " " << col;
            EXPECT_EQ(answer.lead, RivalOf(sums, answer.label) - least) << row << " " << col;
        }
    }
}

TEST(SemiGlobalMatchingTest, AnswersWithTheCheapestOfAllLabellingsOfAllEightPaths) {
    constexpr int kRows = 4;
    constexpr int kCols = 5;
    constexpr int kLabels = 5;
    SemiGlobalMatching matching(kRows, kCols + 3, kLabels, {});
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const RandomGrid grid(kRows, kCols, kLabels, seed);
        matching.Start(kCols);
        grid.WriteTo(matching);
        matching.Solve();
        ExpectCheapest(matching, grid);
    }
}

TEST(SemiGlobalMatchingTest, AGridThatGotNarrowerKnowsNothingOfTheColumnsThatItHad) {
    SemiGlobalMatching matching(3, 6, 4, {});
    for (const int cols : {6, 3, 1}) {
        const RandomGrid grid(3, cols, 4, 9);
        matching.Start(cols);
        grid.WriteTo(matching);
        matching.Solve();
        ExpectCheapest(matching, grid);
    }
}

/// One row of nodes that want a label of their own; grey as given.
SemiGlobalMatching WantingRow(const std::vector<int>& wanted, const std::vector<int>& grey,
                              int price) {
    SemiGlobalMatching matching(1, static_cast<int>(wanted.size()), 32, {});
    matching.Start(static_cast<int>(wanted.size()));
    for (int col = 0; col < matching.cols(); ++col) {
        const auto i = static_cast<std::size_t>(col);
        matching.grey(0, col) = static_cast<std::uint8_t>(grey[i]);
        for (int k = 0; k < 32; ++k)
            matching.costs(0, col)[k] = static_cast<Cost>(
                wanted[i] < 0 ? 20 : std::min(price * std::abs(k - wanted[i]), 64));
    }
    matching.Solve();
    return matching;
}

TEST(SemiGlobalMatchingTest, ANodeThatKnowsNothingTakesTheLabelOfTheSideThatLooksAlike) {
    const auto matching =
        WantingRow({5, 5, 5, 5, -1, 20, 20, 20, 20}, {90, 90, 90, 90, 90, 200, 200, 200, 200}, 16);
    EXPECT_EQ(matching.AnswerAt(0, 3).label, 5);
    EXPECT_EQ(matching.AnswerAt(0, 4).label, 5);
    EXPECT_EQ(matching.AnswerAt(0, 5).label, 20) << "depth jumps where the picture changes";
}

TEST(SemiGlobalMatchingTest, TheMinimumBetweenLabelsIsThatOfTheTwoSlopesBesideIt) {
    SemiGlobalMatching matching(1, 1, 7, {});
    matching.Start(1);
    const std::array<Cost, 7> costs{64, 50, 30, 10, 20, 40, 60};
    std::copy(costs.begin(), costs.end(), matching.costs(0, 0));
    matching.Solve();
    const SemiGlobalMatching::Answer answer = matching.AnswerAt(0, 0);
    EXPECT_EQ(answer.label, 3);
    EXPECT_NEAR(answer.fraction, 0.5 * (20.0 - 10.0) / 30.0, 1e-6);
    EXPECT_EQ(answer.lead, 8 * (40 - 10)) << "eight paths, each of the node alone";
}

TEST(SemiGlobalMatchingTest, AtEitherEndOfTheLabelsThereIsNothingBetween) {
    const auto matching = WantingRow({0, 31}, {10, 250}, 30);
    EXPECT_EQ(matching.AnswerAt(0, 0).label, 0);
    EXPECT_EQ(matching.AnswerAt(0, 1).label, 31);
    EXPECT_EQ(matching.AnswerAt(0, 0).fraction, 0);
    EXPECT_EQ(matching.AnswerAt(0, 1).fraction, 0);
}

}  // namespace
}  // namespace hitchview::algo
