#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace hitchview::app {

/// One member of each of `records`.
template <typename Record, typename Value>
std::vector<Value> Collect(const std::vector<Record>& records, Value Record::*member) {
    std::vector<Value> values(records.size());
    std::ranges::transform(records, values.begin(), member);
    return values;
}

/// All three: empty for no values.
inline std::optional<double> Mean(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

inline std::optional<double> Largest(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    return *std::ranges::max_element(values);
}

/// `share` in [0, 1]; between two values linear.
inline std::optional<double> Quantile(std::vector<double> values, double share) {
    if (values.empty()) return std::nullopt;
    std::ranges::sort(values);
    const double position = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], position - static_cast<double>(below));
}

}  // namespace hitchview::app
