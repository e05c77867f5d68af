#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hitchview::algo {

struct SeamPathOptions {
    float step_cost = 1.5F;    ///< of one column sideways from a row to the next, grey levels
    float middle_cost = 5;     ///< at either end of the range, against its middle; grows squarely
    float keep_cost = 4;       ///< of a place `keep_cols` columns or more from the chosen path
    float keep_cols = 3;       ///< columns
    float least_win = 0.15F;   ///< share by which a path must be cheaper to replace the chosen one
    float least_gain = 0.75F;  ///< and so much per row, grey levels
    float glide_px = 4;        ///< that the drawn path moves per frame towards the chosen one
    /// By how much a place on its way may be dearer than the chosen path, grey levels per row; what
    /// is dearer is skipped.
    float dearest_way = std::numeric_limits<float>::infinity();
};

/// The line from the top to the bottom of a grid on which two pictures meet: a column per row, at
/// most one column further in each row than in the row above. The cheapest such path by dynamic
/// programming (as in seam carving). A path is replaced when another is clearly cheaper. The drawn
/// one glides there as long as its way is cheap, too: a thing that moves along with the line would
/// be cut for many frames, so it is skipped.
class SeamPath {
 public:
    /// Columns that may be used, both ends included.
    struct Range {
        int first = 0;
        int last = -1;
        [[nodiscard]] bool empty() const { return last < first; }
    };

    /// A grid of `rows` x `cols` corners; corner (row, col) lies at x = col spacing_px - 0.5.
    SeamPath(int rows, int cols, double spacing_px, const SeamPathOptions& options);

    /// Towards a straight column by `gain` of what is missing; the first call puts it there.
    void FollowColumn(double x_px, double gain);
    /// Towards the cheapest path. `cost`: rows x cols, grey levels, at least 0; `range` not empty.
    void FollowCheapest(const Range& range, std::span<const float> cost);

    [[nodiscard]] bool known() const { return known_; }
    /// What is drawn, px; of corner row `row`.
    [[nodiscard]] double x_px(int row) const { return drawn_px_[static_cast<std::size_t>(row)]; }
    [[nodiscard]] double mean_px() const;

 private:
    /// Into cheapest_.
    void FindCheapest(const Range& range, std::span<const float> cost);
    [[nodiscard]] double PlaceCost(const Range& range, std::span<const float> cost, int row,
                                   int col) const;
    [[nodiscard]] double KeepCost(int row, int col) const;
    [[nodiscard]] double PriceOf(const std::vector<int>& path, const Range& range,
                                 std::span<const float> cost) const;
    [[nodiscard]] int DrawnColumn(const Range& range, int row) const;
    void Glide();
    void SkipDearWay(const Range& range, std::span<const float> cost);
    void Arrive();
    [[nodiscard]] std::size_t At(int row, int col) const {
        return static_cast<std::size_t>(row * cols_ + col);
    }

    int rows_;
    int cols_;
    double spacing_px_;
    SeamPathOptions options_;
    std::vector<double> price_;      // of the cheapest path down to here
    std::vector<std::int8_t> from_;  // column in the row above, relative
    std::vector<int> cheapest_;
    std::vector<int> chosen_;
    std::vector<double> drawn_px_;
    bool has_chosen_ = false;
    bool known_ = false;
};

}  // namespace hitchview::algo
