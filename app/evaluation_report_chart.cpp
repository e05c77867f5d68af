#include "app/evaluation_report_chart.hpp"

#include <algorithm>
#include <cmath>

#include "app/evaluation_report_axis.hpp"
#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

constexpr double kWidthPx = 760;
constexpr double kHeightPx = 230;
constexpr double kLeftPx = 64;
constexpr double kRightPx = 12;
constexpr double kTopPx = 10;
constexpr double kBottomPx = 40;

struct Axes {
    Axis x;
    Axis y;
};

struct Range {
    double low = INFINITY;
    double high = -INFINITY;

    void Include(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

bool Drawable(const Chart& chart, double x, double y) {
    const bool finite = std::isfinite(x) && std::isfinite(y);
    return finite && (!chart.logarithmic || (x > 0 && y > 0));
}

std::optional<Axes> MakeAxes(const Chart& chart) {
    Range x;
    Range y;
    for (const ChartLine& line : chart.lines) {
        for (std::size_t i = 0; i < line.x.size(); ++i) {
            if (!Drawable(chart, line.x[i], line.y[i])) continue;
            x.Include(line.x[i]);
            y.Include(line.y[i]);
        }
    }
    if (x.low > x.high) return std::nullopt;
    if (chart.lowest_y) y.Include(*chart.lowest_y);
    if (chart.highest_y) y.Include(*chart.highest_y);
    const Scale scale = chart.logarithmic ? Scale::kLogarithmic : Scale::kLinear;
    return Axes{.x = Axis({x.low, x.high}, {kLeftPx, kWidthPx - kRightPx}, scale),
                .y = Axis({y.low, y.high}, {kHeightPx - kBottomPx, kTopPx}, scale)};
}

std::string Line(double x1, double y1, double x2, double y2, const std::string& style) {
    return "<line class=\"" + style + "\" x1=\"" + Number(x1, 1) + "\" y1=\"" + Number(y1, 1) +
           "\" x2=\"" + Number(x2, 1) + "\" y2=\"" + Number(y2, 1) + "\"/>";
}

std::string Text(double x, double y, const std::string& anchor, const std::string& text) {
    return "<text x=\"" + Number(x, 1) + "\" y=\"" + Number(y, 1) + "\" text-anchor=\"" + anchor +
           "\">" + Escaped(text) + "</text>";
}

std::string Grid(const Axes& axes) {
    constexpr double kTextHeightPx = 4;
    std::string svg;
    for (const Tick& tick : axes.y.Ticks()) {
        svg += Line(kLeftPx, tick.px, kWidthPx - kRightPx, tick.px, "grid");
        svg += Text(kLeftPx - 6, tick.px + kTextHeightPx, "end", tick.label);
    }
    for (const Tick& tick : axes.x.Ticks()) {
        svg += Line(tick.px, kTopPx, tick.px, kHeightPx - kBottomPx, "grid");
        svg += Text(tick.px, kHeightPx - kBottomPx + 15, "middle", tick.label);
    }
    return svg;
}

std::string Labels(const Chart& chart) {
    const double middle_y = (kTopPx + kHeightPx - kBottomPx) / 2;
    return Text((kLeftPx + kWidthPx - kRightPx) / 2, kHeightPx - 6, "middle", chart.x_label) +
           "<g transform=\"translate(14 " + Number(middle_y, 1) + ") rotate(-90)\">" +
           Text(0, 0, "middle", chart.y_label) + "</g>";
}

// Points of one column of pixels: its lowest and highest, in the order in which they come.
class Column {
 public:
    void Append(double x, double y) {
        if (low_y_ > high_y_) first_x_ = x;
        low_comes_last_ = y < low_y_ || (low_comes_last_ && y <= high_y_);
        low_y_ = std::min(low_y_, y);
        high_y_ = std::max(high_y_, y);
    }
    [[nodiscard]] std::string Points() const {
        const double early = low_comes_last_ ? high_y_ : low_y_;
        const double late = low_comes_last_ ? low_y_ : high_y_;
        std::string points = Number(first_x_, 1) + ',' + Number(early, 1) + ' ';
        if (late != early) points += Number(first_x_, 1) + ',' + Number(late, 1) + ' ';
        return points;
    }

 private:
    double first_x_ = 0;
    double low_y_ = INFINITY;
    double high_y_ = -INFINITY;
    bool low_comes_last_ = false;
};

std::string Points(const Chart& chart, const ChartLine& line, const Axes& axes) {
    constexpr double kColumnsPerPx = 2;
    std::string points;
    std::optional<Column> maybe_column;
    double column_at = -1;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
        if (!Drawable(chart, line.x[i], line.y[i])) continue;
        const double x_px = axes.x.Px(line.x[i]);
        const double at = std::floor(x_px * kColumnsPerPx);
        if (at != column_at) {
            if (maybe_column) points += maybe_column->Points();
            maybe_column.emplace();
            column_at = at;
        }
        maybe_column->Append(x_px, axes.y.Px(line.y[i]));
    }
    return maybe_column ? points + maybe_column->Points() : points;
}

std::string Lines(const Chart& chart, const Axes& axes) {
    std::string svg;
    for (const ChartLine& line : chart.lines) {
        svg += "<polyline class=\"line " + line.style + "\" points=\"" + Points(chart, line, axes) +
               "\"/>";
    }
    return svg;
}

std::string Mark(const Chart& chart, const Axes& axes) {
    if (!chart.mark_x) return "";
    const double x = axes.x.Px(*chart.mark_x);
    if (x < kLeftPx || x > kWidthPx - kRightPx) return "";
    return Line(x, kTopPx, x, kHeightPx - kBottomPx, "mark");
}

std::string Legend(const Chart& chart) {
    std::string html = "<p class=\"legend\">";
    for (const ChartLine& line : chart.lines) {
        html += "<span class=\"key " + line.style + "\">" + Escaped(line.name) + "</span> ";
    }
    return html + "</p>";
}

}  // namespace

std::string Draw(const Chart& chart) {
    const std::string title = "<h4>" + Escaped(chart.title) + "</h4>";
    const std::optional<Axes> maybe_axes = MakeAxes(chart);
    if (!maybe_axes) return title + "<p class=\"none\">not measured</p>";
    const std::string size = Number(kWidthPx, 0) + ' ' + Number(kHeightPx, 0);
    return title + Legend(chart) + "<svg viewBox=\"0 0 " + size + "\" role=\"img\" aria-label=\"" +
           Escaped(chart.title) + "\">" + Grid(*maybe_axes) + Mark(chart, *maybe_axes) +
           Lines(chart, *maybe_axes) + Labels(chart) + "</svg>";
}

}  // namespace hitchview::app
