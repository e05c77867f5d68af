#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace hitchview::algo {

/// Minimises  sum_t (x_t - 2 x_{t-1} + x_{t-2})^2 + sum_t weight_t (x_t - target_t)^2  over
/// x_0..x_{n-1} with x_{-1} = `early` and x_{-2} = `earlier` given: one pentadiagonal solve,
/// factored as L D L'. weight_t >= 0; at least two positive ones or n = 1. Neither allocates nor
/// pivots: the matrix is positive definite.
template <std::size_t kMax>
class SecondDifferenceSystem {
 public:
    void Solve(double early, double earlier, std::span<const double> weight,
               std::span<const double> target, std::span<double> x) {
        Fill(weight);
        for (std::size_t t = 0; t < weight.size(); ++t) x[t] = weight[t] * target[t];
        x[0] += 2 * early - earlier;
        if (weight.size() > 1) {  // of the second difference at t = 1
            x[0] += 2 * early;
            x[1] -= early;
        }
        Factor(weight.size());
        Substitute(x.first(weight.size()));
    }

 private:
    void Fill(std::span<const double> weight) {
        const std::size_t n = weight.size();
        for (std::size_t t = 0; t < n; ++t) {
            const double later = t + 2 < n ? 5 : t + 1 < n ? 4 : 0;
            diagonal_[t] = 1 + later + weight[t];
            next_[t] = t + 2 < n ? -4 : -2;
            second_next_[t] = 1;
        }
    }

    void Factor(std::size_t n) {
        for (std::size_t t = 0; t < n; ++t) {
            if (t >= 1) diagonal_[t] -= next_[t - 1] * next_[t - 1] * diagonal_[t - 1];
            if (t >= 2) {
                diagonal_[t] -= second_next_[t - 2] * second_next_[t - 2] * diagonal_[t - 2];
            }
            if (t >= 1) next_[t] -= second_next_[t - 1] * diagonal_[t - 1] * next_[t - 1];
            next_[t] /= diagonal_[t];
            second_next_[t] /= diagonal_[t];
        }
    }

    void Substitute(std::span<double> x) const {
        const std::size_t n = x.size();
        for (std::size_t t = 1; t < n; ++t) {
            x[t] -= next_[t - 1] * x[t - 1];
            if (t >= 2) x[t] -= second_next_[t - 2] * x[t - 2];
        }
        for (std::size_t t = n; t-- > 0;) {
            x[t] /= diagonal_[t];
            if (t + 1 < n) x[t] -= next_[t] * x[t + 1];
            if (t + 2 < n) x[t] -= second_next_[t] * x[t + 2];
        }
    }

    std::array<double, kMax> diagonal_{};     // then D
    std::array<double, kMax> next_{};         // first subdiagonal, then of L
    std::array<double, kMax> second_next_{};  // second subdiagonal, then of L
};

}  // namespace hitchview::algo
