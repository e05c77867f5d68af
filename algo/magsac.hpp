#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "algo/fixed_vector.hpp"
#include "algo/motion_models.hpp"

namespace hitchview::algo {

/// The robust cost of MAGSAC++ (Barath et al., CVPR 2020) for residuals of a 2-D point (chi
/// distribution with 2 degrees of freedom): the noise level sigma is not known, only that it lies
/// between 0 and `max_sigma_px`, and is marginalised out.
///     weight(r) = erfc(r / (sqrt 2 s)) - erfc(k / sqrt 2),   0 beyond r = k s
/// with s = max_sigma_px, k = 3.04 (99 % of the inliers), scaled to weight(0) = 1; the cost is the
/// integral of r weight(r), constant beyond k s. Both are read from a table.
class MagsacCost {
 public:
    explicit MagsacCost(double max_sigma_px);

    [[nodiscard]] double Weight(double squared_residual) const {
        return Read(weight_, squared_residual);
    }
    /// In [0, 1]: 1 for an outlier.
    [[nodiscard]] double Cost(double squared_residual) const {
        return Read(cost_, squared_residual);
    }
    [[nodiscard]] double cutoff_px() const { return cutoff_px_; }

 private:
    static constexpr int kCells = 256;
    using Table = std::array<double, kCells + 1>;
    [[nodiscard]] double Read(const Table& table, double squared_residual) const {
        const double at = std::sqrt(squared_residual) * cells_per_px_;
        if (!(at < kCells)) return table[kCells];
        const auto i = static_cast<std::size_t>(at);
        return table[i] + (at - static_cast<double>(i)) * (table[i + 1] - table[i]);
    }

    double cutoff_px_;
    double cells_per_px_;
    Table weight_{};
    Table cost_{};
};

struct MagsacOptions {
    double max_sigma_px = 1.5;
    int max_iterations = 200;   ///< bound on the samples drawn
    int polish_steps = 6;       ///< reweighted least squares on the best sample
    double confidence = 0.999;  ///< of having drawn one clean sample: sampling may end earlier
    std::uint32_t seed = 1;
};

struct MagsacFit {
    Eigen::Matrix3d model;
    int inliers;       ///< pairs with a residual below the cut-off
    double mean_cost;  ///< 0: all pairs agree, 1: none
};

/// Fits one motion model to pairs of which many may be wrong. Seeded, bounded, takes no memory
/// after construction: the same pairs give the same answer. Paper eq. (5): rho is MAGSAC++.
template <typename Model, std::size_t kCapacity>
class MagsacEstimator {
 public:
    using Pairs = FixedVector<RayPair, kCapacity>;

    explicit MagsacEstimator(const MagsacOptions& options)
        : options_(options), cost_(options.max_sigma_px) {}

    /// `px_per_unit`: see Model::SquaredResidual. Empty if no model was found that at least
    /// kMinimal + 2 pairs agree on.
    std::optional<MagsacFit> Fit(const Pairs& pairs, double px_per_unit = 1) {
        if (pairs.count() < Model::kMinimal + 2) return std::nullopt;
        random_ = options_.seed;
        px_per_unit_ = px_per_unit;
        MagsacFit best{Eigen::Matrix3d::Identity(), 0, 1e9};
        int needed = options_.max_iterations;
        for (int i = 0; i < needed; ++i) {
            const auto sample = FitSample(pairs);
            if (!sample || !Improves(pairs, *sample, best)) continue;
            Polish(pairs, 2, best);
            needed = std::min(needed, i + 1 + SamplesNeeded(pairs, best));
        }
        if (best.mean_cost > 1) return std::nullopt;
        Polish(pairs, options_.polish_steps, best);
        best.inliers = CountInliers(pairs, best.model);
        if (best.inliers < Model::kMinimal + 2) return std::nullopt;
        return best;
    }

    [[nodiscard]] double SquaredResidual(const Eigen::Matrix3d& m, const RayPair& pair) const {
        return Model::SquaredResidual(m, pair, px_per_unit_);
    }
    [[nodiscard]] bool IsInlier(const Eigen::Matrix3d& m, const RayPair& pair) const {
        return SquaredResidual(m, pair) < cost_.cutoff_px() * cost_.cutoff_px();
    }

 private:
    std::uint32_t Random() {  // xorshift32 (Marsaglia 2003)
        random_ ^= random_ << 13;
        random_ ^= random_ >> 17;
        random_ ^= random_ << 5;
        return random_;
    }

    std::optional<Eigen::Matrix3d> FitSample(const Pairs& pairs) {
        std::array<RayPair, Model::kMinimal> sample;
        std::array<double, Model::kMinimal> ones;
        ones.fill(1);
        std::array<std::size_t, Model::kMinimal> chosen{};
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            const auto end = chosen.begin() + static_cast<std::ptrdiff_t>(k);
            do {
                chosen[k] = Random() % pairs.size();
            } while (std::find(chosen.begin(), end, chosen[k]) != end);
            sample[k] = pairs[chosen[k]];
        }
        return Model::Fit(sample, ones);
    }

    /// Takes `model` over into `best` if its cost is lower; gives up summing as soon as it is not.
    bool Improves(const Pairs& pairs, const Eigen::Matrix3d& model, MagsacFit& best) const {
        const auto n = static_cast<double>(pairs.size());
        const double limit = best.mean_cost * n;
        double sum = 0;
        for (const RayPair& pair : pairs) {
            sum += cost_.Cost(SquaredResidual(model, pair));
            if (sum >= limit) return false;
        }
        best = {model, 0, sum / n};
        return true;
    }

    void Polish(const Pairs& pairs, int steps, MagsacFit& best) {
        for (int i = 0; i < steps; ++i) {
            for (std::size_t k = 0; k < pairs.size(); ++k) {
                weights_[k] = cost_.Weight(SquaredResidual(best.model, pairs[k]));
            }
            const auto model =
                Model::Fit({pairs.data(), pairs.size()}, {weights_.data(), pairs.size()});
            if (!model || !Improves(pairs, *model, best)) return;
        }
    }

    int SamplesNeeded(const Pairs& pairs, const MagsacFit& best) const {
        const double share = CountInliers(pairs, best.model) / static_cast<double>(pairs.size());
        const double clean = std::pow(share, Model::kMinimal);
        if (clean > 0.999) return 1;
        if (clean < 1e-4) return options_.max_iterations;
        return static_cast<int>(std::log(1 - options_.confidence) / std::log(1 - clean)) + 1;
    }

    int CountInliers(const Pairs& pairs, const Eigen::Matrix3d& model) const {
        int count = 0;
        for (const RayPair& pair : pairs) count += IsInlier(model, pair) ? 1 : 0;
        return count;
    }

    MagsacOptions options_;
    MagsacCost cost_;
    double px_per_unit_ = 1;
    std::uint32_t random_ = 1;
    std::array<double, kCapacity> weights_{};
};

}  // namespace hitchview::algo
