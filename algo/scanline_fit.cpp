#include "algo/scanline_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/core/hal/intrin.hpp>

#include "algo/multiversion.hpp"

namespace hitchview::algo {
namespace {

constexpr int kValues = ScanlineFit::kValues;
using Price = ScanlineFit::Price;

constexpr int kPerVote = 128;  // Price of one vote
/// No way is thought to be this much dearer than the cheapest.
constexpr Price kDear = 16000;
/// Dearer than any way, with room for a few steps more.
constexpr Price kNever = 30000;

Price PriceOf(double votes) {
    return static_cast<Price>(std::lround(kPerVote * votes));
}

/// Changes from row to row.
struct Changes {
    Price step;  ///< of one value to the next
    Price most;  ///< of any
};

/// Lets values be taken from neighbours, for no more than `most`: at first from those beside, then
/// from ever farther ones.
HV_MULTIVERSION
void Spread(const Changes& change, Price* __restrict wish) {
    constexpr int kMargin = kValues / 2;
    std::array<Price, kValues + 2 * kMargin> padded;
    padded.fill(change.most);
    Price* own = padded.data() + kMargin;
    int reach = 0;
    for (int away = 1; away <= kMargin && reach * change.step < change.most; away *= 2) {
        std::copy_n(wish, kValues, own);
        const auto step = static_cast<Price>(std::min<int>(away * change.step, change.most));
        for (int k = 0; k < kValues; ++k) {
            const auto moved = static_cast<Price>(std::min(own[k - away], own[k + away]) + step);
            wish[k] = std::min(own[k], moved);
        }
        reach += away;
    }
}

/// Tells a node the wish of those before it, and adds its own; `kept`: the bits of what it heard
/// before that count.
HV_MULTIVERSION
void HandOn(const Price* __restrict cost, Price most, Price kept, Price* __restrict wish,
            Price* __restrict heard) {
    Price least = kNever;
    for (int k = 0; k < kValues; ++k) {
        heard[k] = static_cast<Price>((heard[k] & kept) + wish[k]);
        wish[k] = static_cast<Price>(wish[k] + cost[k]);
        least = std::min(least, wish[k]);
    }
    for (int k = 0; k < kValues; ++k) wish[k] = std::min(static_cast<Price>(wish[k] - least), most);
}

/// Takes the least price away, which only keeps the numbers small.
inline void Level(Price* price) {
    Price least = kNever;
    for (int k = 0; k < kValues; ++k) least = std::min(least, price[k]);
    for (int k = 0; k < kValues; ++k) price[k] = static_cast<Price>(price[k] - least);
}

/// Prices of the first node of a row.
HV_MULTIVERSION
void Begin(const Price* __restrict cost, const Price* __restrict heard, Price* __restrict price) {
    for (int k = 0; k < kValues; ++k) price[k] = static_cast<Price>(cost[k] + heard[k]);
    Level(price);
}

/// Prices of a node from those of the node before.
HV_MULTIVERSION
void Reach(const Price* __restrict before, const Price* __restrict cost,
           const Price* __restrict heard, int most_steps, Price change, Price* __restrict price) {
    std::array<Price, kValues> cheapest;
    for (int k = 0; k < kValues; ++k) cheapest[k] = std::min(before[k], kDear);
    for (int away = 1; away <= most_steps; ++away) {
        const auto dearer = static_cast<Price>(change * away);
        for (int k = 0; k < kValues; ++k) {
            const Price nearest = std::min(before[k - away], before[k + away]);
            cheapest[k] = std::min(cheapest[k], static_cast<Price>(nearest + dearer));
        }
    }
    for (int k = 0; k < kValues; ++k)
        price[k] = static_cast<Price>(cheapest[k] + cost[k] + heard[k]);
    Level(price);
}

}  // namespace

ScanlineFit::ScanlineFit(int rows, int max_cols, const ScanlineFitOptions& options)
    : rows_(rows),
      max_cols_(max_cols),
      options_(options),
      change_(PriceOf(options.change_cost)),
      cost_(Index(rows, 0) + Ballot::kMost),
      heard_(Index(rows, 0)),
      wish_(Index(1, 0)),
      price_(static_cast<std::size_t>(max_cols * (kValues + 2 * options.most_steps)), kNever),
      answer_(static_cast<std::size_t>(rows * max_cols)) {}

void ScanlineFit::Start(int cols) {
    cols_ = cols;
    for (int row = 0; row < rows_; ++row) {
        const auto first = static_cast<std::ptrdiff_t>(Index(row, 0));
        const auto last = static_cast<std::ptrdiff_t>(Index(row, cols));
        std::fill(cost_.begin() + first, cost_.begin() + last, Price{0});
    }
}

ScanlineFit::Ballot ScanlineFit::BallotFor(float value_px) const {
    const auto step = static_cast<float>(options_.step_px);
    const float centre = (value_px - static_cast<float>(options_.lowest_px)) / step;
    const float reach = static_cast<float>(options_.tolerance_px) / step;
    const float first = std::clamp(centre - reach, -1.0F, static_cast<float>(kValues - 1));
    Ballot ballot;
    ballot.first = static_cast<int>(first + 1);
    for (float& share : ballot.shares) {
        const auto k = static_cast<float>(ballot.first + ballot.count);
        if (k >= std::min(centre + reach, static_cast<float>(kValues))) break;
        share = static_cast<float>(kPerVote) * (1 - std::abs(k - centre) / reach);
        ++ballot.count;
    }
    return ballot;
}

void ScanlineFit::Vote(int row, int col, const Ballot& ballot, float weight) {
    Price* cost = cost_.data() + Index(row, col) + ballot.first;
    const auto votes = [&](std::size_t i) {
        const cv::v_float32x4 shares = cv::v_load(ballot.shares.data() + i);
        return cv::v_trunc(shares * cv::v_setall_f32(weight) + cv::v_setall_f32(0.5F));
    };
    static_assert(Ballot::kMost == 8);
    cv::v_store(cost, cv::v_load(cost) - cv::v_pack(votes(0), votes(4)));
}

void ScanlineFit::Solve() {
    Listen(1);
    Listen(-1);
    for (int row = 0; row < rows_; ++row) SolveRow(row);
}

/// Hands on, from row to row, what the rows before want; it fades with each change.
void ScanlineFit::Listen(int down) {
    const Changes change{PriceOf(options_.change_cost_down), PriceOf(options_.most_cost_down)};
    const Price kept = down > 0 ? Price{0} : Price{-1};  // those above are heard first
    std::fill(wish_.begin(), wish_.end(), Price{0});
    for (int i = 0; i < rows_; ++i) {
        const int row = down > 0 ? i : rows_ - 1 - i;
        for (int col = 0; col < cols_; ++col) {
            const std::size_t at = Index(row, col);
            Price* wish = wish_.data() + Index(0, col);
            HandOn(cost_.data() + at, change.most, kept, wish, heard_.data() + at);
            Spread(change, wish);
        }
    }
}

void ScanlineFit::SolveRow(int row) {
    for (int col = 0; col < cols_; ++col) {
        const Price* cost = cost_.data() + Index(row, col);
        const Price* heard = heard_.data() + Index(row, col);
        if (col == 0)
            Begin(cost, heard, PricesOf(col));
        else
            Reach(PricesOf(col - 1), cost, heard, options_.most_steps, change_, PricesOf(col));
    }
    const Price* end = PricesOf(cols_ - 1);
    auto k = static_cast<int>(std::min_element(end, end + kValues) - end);
    for (int col = cols_ - 1; col >= 0; --col) {
        answer_[static_cast<std::size_t>(row * max_cols_ + col)] = static_cast<std::int8_t>(k);
        if (col > 0) k = Before(col, k);
    }
}

/// The value of the node before `col` on the cheapest way to value `k`.
int ScanlineFit::Before(int col, int k) {
    const Price* before = PricesOf(col - 1);
    const auto price = [&](int j) { return before[j] + change_ * std::abs(j - k); };
    int best = std::max(0, k - options_.most_steps);
    const int last = std::min(kValues - 1, k + options_.most_steps);
    for (int j = best + 1; j <= last; ++j) {
        if (price(j) < price(best)) best = j;
    }
    return best;
}

}  // namespace hitchview::algo
