#include "algo/seam_path.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hitchview::algo {

SeamPath::SeamPath(int rows, int cols, double spacing_px, const SeamPathOptions& options)
    : rows_(rows),
      cols_(cols),
      spacing_px_(spacing_px),
      options_(options),
      price_(static_cast<std::size_t>(rows * cols)),
      from_(static_cast<std::size_t>(rows * cols)),
      cheapest_(static_cast<std::size_t>(rows)),
      chosen_(static_cast<std::size_t>(rows)),
      drawn_px_(static_cast<std::size_t>(rows)) {}

void SeamPath::FollowColumn(double x_px, double gain) {
    for (double& drawn_px : drawn_px_) drawn_px += (known_ ? gain : 1.0) * (x_px - drawn_px);
    known_ = true;
    has_chosen_ = false;
}

void SeamPath::FollowCheapest(const Range& range, std::span<const float> cost) {
    for (int& col : chosen_) col = std::clamp(col, range.first, range.last);
    FindCheapest(range, cost);
    if (has_chosen_) {
        const double old_price = PriceOf(chosen_, range, cost);
        const double least_gain =
            std::max(options_.least_win * old_price, double{options_.least_gain} * rows_);
        if (old_price - PriceOf(cheapest_, range, cost) > least_gain) chosen_ = cheapest_;
    } else {
        chosen_ = cheapest_;
    }
    has_chosen_ = true;
    Glide();
    SkipDearWay(range, cost);
}

double SeamPath::PlaceCost(const Range& range, std::span<const float> cost, int row,
                           int col) const {
    const double half = std::max(1.0, 0.5 * (range.last - range.first));
    const double off_middle = (col - 0.5 * (range.first + range.last)) / half;
    return cost[At(row, col)] + options_.middle_cost * off_middle * off_middle;
}

double SeamPath::KeepCost(int row, int col) const {
    if (!has_chosen_) return 0;
    const double away = std::abs(col - chosen_[static_cast<std::size_t>(row)]);
    return options_.keep_cost * std::min(1.0, away / options_.keep_cols);
}

void SeamPath::FindCheapest(const Range& range, std::span<const float> cost) {
    for (int row = 0; row < rows_; ++row) {
        for (int col = range.first; col <= range.last; ++col) {
            const double here = PlaceCost(range, cost, row, col) + KeepCost(row, col);
            price_[At(row, col)] = here;
            if (row == 0) continue;
            int best = 0;  // straight on where nothing else is cheaper
            double above = price_[At(row - 1, col)];
            for (const int side : {-1, 1}) {
                const int from = col + side;
                if (from < range.first || from > range.last) continue;
                const double price = price_[At(row - 1, from)] + options_.step_cost;
                if (price < above) {
                    above = price;
                    best = side;
                }
            }
            price_[At(row, col)] += above;
            from_[At(row, col)] = static_cast<std::int8_t>(best);
        }
    }
    const auto last_row = price_.begin() + static_cast<std::ptrdiff_t>(At(rows_ - 1, 0));
    int col = static_cast<int>(std::min_element(last_row + range.first, last_row + range.last + 1) -
                               last_row);
    for (int row = rows_ - 1; row >= 0; --row) {
        cheapest_[static_cast<std::size_t>(row)] = col;
        if (row > 0) col += from_[At(row, col)];
    }
}

double SeamPath::PriceOf(const std::vector<int>& path, const Range& range,
                         std::span<const float> cost) const {
    double price = 0;
    int sideways = 0;
    for (int row = 0; row < rows_; ++row) {
        const int col = path[static_cast<std::size_t>(row)];
        price += PlaceCost(range, cost, row, col);
        if (row > 0) sideways += std::abs(col - path[static_cast<std::size_t>(row - 1)]);
    }
    return price + double{options_.step_cost} * sideways;
}

void SeamPath::Glide() {
    const double most_px = options_.glide_px;
    for (std::size_t row = 0; row < drawn_px_.size(); ++row) {
        const double missing_px = chosen_[row] * spacing_px_ - 0.5 - drawn_px_[row];
        drawn_px_[row] += known_ ? std::clamp(missing_px, -most_px, most_px) : missing_px;
    }
    known_ = true;
}

int SeamPath::DrawnColumn(const Range& range, int row) const {
    return std::clamp(static_cast<int>(std::lround((x_px(row) + 0.5) / spacing_px_)), range.first,
                      range.last);
}

/// All rows at once: a path that is drawn in pieces would cut along the rows.
void SeamPath::SkipDearWay(const Range& range, std::span<const float> cost) {
    double more = 0;
    for (int row = 0; row < rows_; ++row) {
        more += PlaceCost(range, cost, row, DrawnColumn(range, row)) -
                PlaceCost(range, cost, row, chosen_[static_cast<std::size_t>(row)]);
    }
    if (more > double{options_.dearest_way} * rows_) Arrive();
}

void SeamPath::Arrive() {
    for (std::size_t row = 0; row < drawn_px_.size(); ++row)
        drawn_px_[row] = chosen_[row] * spacing_px_ - 0.5;
}

double SeamPath::mean_px() const {
    return std::accumulate(drawn_px_.begin(), drawn_px_.end(), 0.0) / rows_;
}

}  // namespace hitchview::algo
