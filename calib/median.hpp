#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace hitchview::calib {

/// The middle one by size; the larger of two in the middle. `values`: at least one.
inline double Median(std::vector<double> values) {
    const auto middle = values.begin() + std::ssize(values) / 2;
    std::ranges::nth_element(values, middle);
    return *middle;
}

}  // namespace hitchview::calib
