#pragma once

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

    ScanlineFit(int rows, int max_cols, const ScanlineFitOptions& options);

    /// Begins anew, with the first `cols` columns.
    void Start(int cols);
    void Vote(int row, int col, float value_px, float weight);
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
    void Listen(int col, int down);
    void SolveRow(int row);
    void Reach(int row, int col);
    [[nodiscard]] int Before(int col, int k) const;
    /// Prices of the cheapest ways along a row to the values of a node.
    [[nodiscard]] std::size_t PriceIndex(int col) const {
        return static_cast<std::size_t>(col * (kValues + 2 * options_.most_steps) +
                                        options_.most_steps);
    }

    int rows_;
    int max_cols_;
    int cols_ = 0;
    ScanlineFitOptions options_;
    std::vector<float> cost_;   // less votes: less than 0
    std::vector<float> heard_;  // from above and below
    std::vector<float> price_;  // between values that nobody takes
    std::vector<std::int8_t> answer_;
};

}  // namespace hitchview::algo
