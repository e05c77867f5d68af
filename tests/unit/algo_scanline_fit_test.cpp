#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "algo/scanline_fit.hpp"

namespace hitchview::algo {
namespace {

constexpr int kValues = ScanlineFit::kValues;

double ValueOf(int k) {
    const ScanlineFitOptions o;
    return o.lowest_px + o.step_px * k;
}
int LabelOf(float value_px) {
    const ScanlineFitOptions o;
    return static_cast<int>(std::lround((value_px - o.lowest_px) / o.step_px));
}

/// Votes of the nodes of a chain, and what they say to a value.
class Chain {
 public:
    Chain(int nodes, std::uint64_t seed) {
        cv::RNG random(seed);
        for (int i = 0; i < nodes; ++i) {
            votes_.emplace_back();
            for (int v = 0; v < 3; ++v)
                votes_.back().push_back(
                    {random.uniform(-34.0F, 60.0F), random.uniform(0.1F, 5.0F)});
        }
    }
    struct Vote {
        float value_px;
        float weight;
    };
    [[nodiscard]] int nodes() const { return static_cast<int>(votes_.size()); }
    [[nodiscard]] const std::vector<Vote>& of(int node) const {
        return votes_[static_cast<std::size_t>(node)];
    }
    [[nodiscard]] double Agreement(int node, int k) const {
        double sum = 0;
        for (const Vote& v : of(node)) {
            const double miss = std::abs(ValueOf(k) - double{v.value_px});
            sum += double{v.weight} * std::max(0.0, 1 - miss / ScanlineFitOptions{}.tolerance_px);
        }
        return sum;
    }
    /// Least price of all labellings from `node` on whose label before was `before`.
    template <typename ChangeCost>
    [[nodiscard]] double Cheapest(int node, int before, const ChangeCost& change_cost) const {
        if (node == nodes()) return 0;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k < kValues; ++k) {
            const double change = node == 0 ? 0 : change_cost(std::abs(k - before));
            if (std::isinf(change)) continue;
            least =
                std::min(least, change - Agreement(node, k) + Cheapest(node + 1, k, change_cost));
        }
        return least;
    }
    template <typename ChangeCost>
    [[nodiscard]] double PriceOf(const std::vector<int>& labels,
                                 const ChangeCost& change_cost) const {
        double price = 0;
        for (int i = 0; i < nodes(); ++i) {
            const int k = labels[static_cast<std::size_t>(i)];
            price -= Agreement(i, k);
            if (i > 0) price += change_cost(std::abs(k - labels[static_cast<std::size_t>(i - 1)]));
        }
        return price;
    }

 private:
    std::vector<std::vector<Vote>> votes_;
};

TEST(ScanlineFitTest, OfAllRowsWhoseNeighboursAreNearItFindsTheOneWithMostVotes) {
    const auto change_cost = [](int steps) {
        const ScanlineFitOptions o;
        return steps > o.most_steps ? std::numeric_limits<double>::infinity()
                                    : o.change_cost * steps;
    };
    ScanlineFit fit(1, 8, {});
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Chain row(4, seed);
        fit.Start(row.nodes());
        std::vector<int> labels;
        for (int col = 0; col < row.nodes(); ++col) {
            for (const auto& vote : row.of(col))
                fit.Vote(0, col, fit.BallotFor(vote.value_px), vote.weight);
        }
        fit.Solve();
        for (int col = 0; col < row.nodes(); ++col) labels.push_back(LabelOf(fit.At(0, col)));
        EXPECT_NEAR(row.PriceOf(labels, change_cost), row.Cheapest(0, 0, change_cost), 1e-4)
            << seed;
    }
}

TEST(ScanlineFitTest, OfAllColumnsItFindsTheOneWithMostVotesWhereEdgesHaveABoundedPrice) {
    const auto change_cost = [](int steps) {
        const ScanlineFitOptions o;
        return std::min(o.change_cost_down * steps, o.most_cost_down);
    };
    ScanlineFit fit(3, 1, {});
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Chain column(3, seed);
        fit.Start(1);
        for (int row = 0; row < column.nodes(); ++row) {
            for (const auto& vote : column.of(row))
                fit.Vote(row, 0, fit.BallotFor(vote.value_px), vote.weight);
        }
        fit.Solve();
        std::vector<int> labels;
        for (int row = 0; row < column.nodes(); ++row) labels.push_back(LabelOf(fit.At(row, 0)));
        EXPECT_NEAR(column.PriceOf(labels, change_cost), column.Cheapest(0, 0, change_cost), 1e-4)
            << seed;
    }
}

/// One row: everything votes for 0, columns first..last with twice the weight for `near_px`.
std::vector<float> RowWithNear(int first, int last, float near_px) {
    constexpr int kCols = 48;
    ScanlineFit fit(1, kCols, {});
    fit.Start(kCols);
    for (int col = 0; col < kCols; ++col) {
        const bool near = col >= first && col <= last;
        fit.Vote(0, col, fit.BallotFor(near ? near_px : 0), near ? 2 : 1);
    }
    fit.Solve();
    std::vector<float> row;
    for (int col = 0; col < kCols; ++col) row.push_back(fit.At(0, col));
    return row;
}

TEST(ScanlineFitTest, AWideNearThingIsFollowedByARampThatDoesNotFold) {
    const ScanlineFitOptions options;
    const std::vector<float> row = RowWithNear(15, 32, 60);
    EXPECT_EQ(row[24], 60);
    EXPECT_EQ(row[2], 0);
    EXPECT_EQ(row[45], 0);
    for (std::size_t col = 1; col < row.size(); ++col)
        EXPECT_LE(std::abs(row[col] - row[col - 1]), options.most_steps * options.step_px);
}

TEST(ScanlineFitTest, AThinNearThingLeavesItsPlaceToWhatLiesBehindIt) {
    for (const float value : RowWithNear(24, 25, 60)) EXPECT_EQ(value, 0);
}

TEST(ScanlineFitTest, NothingIsLeftOfTheVotesBeforeTheStart) {
    ScanlineFit fit(2, 6, {});
    fit.Start(6);
    for (int col = 0; col < 6; ++col) fit.Vote(1, col, fit.BallotFor(90), 5);
    fit.Solve();
    ASSERT_EQ(fit.At(0, 3), 90);
    fit.Start(6);
    for (int col = 0; col < 6; ++col) fit.Vote(0, col, fit.BallotFor(-12), 1);
    fit.Solve();
    for (int row = 0; row < 2; ++row) {
        for (int col = 0; col < 6; ++col) EXPECT_EQ(fit.At(row, col), -12) << row << " " << col;
    }
}

TEST(ScanlineFitTest, AVoteBeyondAllValuesCountsForNone) {
    ScanlineFit fit(1, 1, {});
    fit.Start(1);
    fit.Vote(0, 0, fit.BallotFor(1e4F), 50);
    fit.Vote(0, 0, fit.BallotFor(-1e4F), 50);
    fit.Vote(0, 0, fit.BallotFor(27), 0.1F);
    fit.Solve();
    EXPECT_EQ(fit.At(0, 0), 27);
}

}  // namespace
}  // namespace hitchview::algo
