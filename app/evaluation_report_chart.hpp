#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hitchview::app {

/// One line; `x` and `y` of one length, `x` rising.
struct ChartLine {
    std::string name;   ///< in the legend
    std::string style;  ///< CSS classes: one of first, second, muted; dashed beside it or not
    std::vector<double> x;
    std::vector<double> y;
};

struct Chart {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<ChartLine> lines;
    bool logarithmic = false;           ///< both axes; only points above 0 are drawn
    std::optional<double> mark_x{};     ///< where an upright line stands
    std::optional<double> lowest_y{};   ///< the axis begins here or below; empty: at the data
    std::optional<double> highest_y{};  ///< the axis ends here or above; empty: at the data
};

/// The chart as an <svg> element with a legend; a line of text if there is nothing to draw. Colours
/// are the style sheet's. Of many points per pixel the extremes are drawn, so that no peak is lost.
std::string Draw(const Chart& chart);

}  // namespace hitchview::app
