#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hitchview::app {

enum class Scale { kLinear, kLogarithmic };

struct Tick {
    double px = 0;
    std::string label;
};

/// One axis of a chart. `ends`: the smallest and the largest value, above 0 for a logarithmic
/// scale; `ends_px`: where they stand on the picture, in either order. A range without length is
/// widened.
class Axis {
 public:
    Axis(std::pair<double, double> ends, std::pair<double, double> ends_px, Scale scale);

    [[nodiscard]] double Px(double value) const;
    /// At round values: steps of 1, 2 or 5 times a power of ten, or the powers of ten.
    [[nodiscard]] std::vector<Tick> Ticks() const;

 private:
    [[nodiscard]] std::vector<Tick> Decades() const;

    double low_;  ///< of the value, or of its logarithm to base 10
    double high_;
    std::pair<double, double> ends_px_;
    Scale scale_;
};

}  // namespace hitchview::app
