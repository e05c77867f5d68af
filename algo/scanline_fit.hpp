#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace hitchview::algo {

struct ScanlineFitOptions {
    double lowest_px = -30;         ///< smallest value that a node can have
    double step_px = 3;             ///< between two values
    double tolerance_px = 6;        ///< of a vote: at this distance it counts no more
    double change_cost = 0.3;       ///< of one step between neighbours in a row, in votes
    double change_cost_down = 0.3;  ///< likewise between rows
    double most_cost_down = 2;      ///< of any change between rows: depth has edges
    int most_steps = 3;             ///< between neighbours in a row
};

/// Gives each node of a grid the value that most votes agree to, under the condition that
/// neighbours in a row differ by at most `most_steps` steps: of all fields that do not fold, the
/// one that aligns most. So a thin near thing, for which there is no room, leaves its place to what
/// lies behind it. Rows are solved exactly (dynamic programming; Viterbi 1967) after each has heard
/// what the rows above and below it want. Memory is taken at construction; not thread-safe.
class ScanlineFit {
 public:
    static constexpr int kValues = 64;
    using Price = std::int16_t;  ///< in parts of a vote

    /// What a vote for a value counts for the values near it.
    struct Ballot {
        static constexpr std::size_t kMost = 8;
        int first = 0;  ///< of these values
        int count = 0;
        std::array<float, kMost> shares{};  ///< 0 from `count` on
    };

    /// `tolerance_px` must be less than Ballot::kMost / 2 steps, and the votes of a node be no more
    /// than 64.
    ScanlineFit(int rows, int max_cols, const ScanlineFitOptions& options);

    /// Begins anew, with the first `cols` columns.
    void Start(int cols);
    [[nodiscard]] Ballot BallotFor(float value_px) const;
    void Vote(int row, int col, const Ballot& ballot, float weight);
    void Solve();
    [[nodiscard]] float At(int row, int col) const {
        return ValueOf(answer_[static_cast<std::size_t>(row * max_cols_ + col)]);
    }

 private:
    [[nodiscard]] std::size_t Index(int row, int col) const {
        return static_cast<std::size_t>(row * max_cols_ + col) * kValues;
    }
    [[nodiscard]] float ValueOf(int k) const {
        return static_cast<float>(options_.lowest_px + options_.step_px * k);
    }
    void Listen(int down);
    void SolveRow(int row);
    [[nodiscard]] int Before(int col, int k);
    /// Prices of the cheapest ways along a row to the values of a node, less the least of them;
    /// between values that nobody takes.
    [[nodiscard]] Price* PricesOf(int col) {
        const int at = col * (kValues + 2 * options_.most_steps) + options_.most_steps;
        return price_.data() + at;
    }

    int rows_;
    int max_cols_;
    int cols_ = 0;
    ScanlineFitOptions options_;
    Price change_;              // of one step between neighbours in a row
    std::vector<Price> cost_;   // less votes: less than 0
    std::vector<Price> heard_;  // from above and below
    std::vector<Price> wish_;   // of the rows before, of each column
    std::vector<Price> price_;
    std::vector<std::int8_t> answer_;
};

}  // namespace hitchview::algo
