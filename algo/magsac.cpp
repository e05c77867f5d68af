#include "algo/magsac.hpp"

#include <numbers>

namespace hitchview::algo {

MagsacCost::MagsacCost(double max_sigma_px)
    : cutoff_px_(3.0349 * max_sigma_px), cells_per_px_(kCells / cutoff_px_) {
    const double step = cutoff_px_ / kCells;
    const double unit = 1 / (std::numbers::sqrt2 * max_sigma_px);
    const double rim = std::erfc(cutoff_px_ * unit);
    for (std::size_t i = 0; i <= kCells; ++i) {
        const double r = step * static_cast<double>(i);
        weight_[i] = (std::erfc(r * unit) - rim) / (1 - rim);
        if (i > 0) {  // trapezoid rule for the integral of r weight(r)
            cost_[i] = cost_[i - 1] + 0.5 * step * (r * weight_[i] + (r - step) * weight_[i - 1]);
        }
    }
    for (double& c : cost_) c /= cost_[kCells];
}

}  // namespace hitchview::algo
