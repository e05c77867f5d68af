#include "app/calib_report_picture.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/calib_report_json.hpp"
#include "app/calib_report_svg.hpp"
#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr double kSmall = 480;  // width of a drawing that has a neighbour
constexpr double kLarge = 960;  // and of one that has none
constexpr std::size_t kMostCells = 64;
constexpr std::size_t kMostDrawn = 4000;

std::string Frame(const PictureSize& size, double scale, const std::string& title,
                  const std::string& content) {
    const double width = size.width_px * scale;
    const double height = size.height_px * scale;
    return Svg(width, height, title, content + SvgBox(0, 0, width, height, "frame", 0));
}

std::string MapFigure(const std::string& svg, const std::string& caption) {
    return "<figure class=\"map\">" + svg + "<figcaption>" + Escaped(caption) +
           "</figcaption></figure>";
}

std::string CellText(double x, double y, double width, double height, const std::string& text) {
    constexpr double kTextHeight = 4;
    return SvgText(x + width / 2, y + height / 2 + kTextHeight, "middle", text);
}

/// Empty unless it is a table of numbers.
std::vector<std::vector<double>> Rows(const json& cells) {
    std::vector<std::vector<double>> rows;
    if (!cells.is_array() || cells.size() > kMostCells) return {};
    for (const json& row : cells) {
        rows.push_back(NumbersOf(row));
        if (rows.back().empty() || rows.back().size() != rows.front().size() ||
            rows.back().size() > kMostCells)
            return {};
    }
    return rows;
}

/// Rows of at least `count` numbers that lie in reach of the picture.
std::vector<std::vector<double>> Points(const json& list, std::size_t count, std::size_t first) {
    constexpr double kFarthest_px = 1e5;
    std::vector<std::vector<double>> points;
    if (!list.is_array()) return points;
    for (const json& item : list) {
        std::vector<double> point = NumbersOf(item);
        if (point.size() < count) continue;
        if (std::all_of(point.begin() + static_cast<std::ptrdiff_t>(first), point.end(),
                        [](double n) { return std::abs(n) < kFarthest_px; }))
            points.push_back(std::move(point));
    }
    return points;
}

/// Distance of the grid's lines in one direction.
double Step(const std::vector<std::vector<double>>& points, std::size_t at, double whole) {
    std::set<double> values;
    for (const auto& point : points) values.insert(point[at]);
    double step = whole;
    for (auto a = values.begin(); a != values.end() && std::next(a) != values.end(); ++a)
        step = std::min(step, *std::next(a) - *a);
    return std::max(step, whole / kMostCells);
}

/// 1, 2 or 5 times a power of ten, at most `largest`.
double RoundBelow(double largest) {
    const double decade = std::pow(10, std::floor(std::log10(largest)));
    for (const double digit : {5.0, 2.0}) {
        if (digit * decade <= largest) return digit * decade;
    }
    return decade;
}

double Percentile(std::vector<double> values, double share) {
    const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
    return values[at];
}

}  // namespace

std::string CoverageMap(const json& cells, const PictureSize& size) {
    const auto rows = Rows(cells);
    if (rows.empty()) return kNotInFile;
    const double scale = kSmall / size.width_px;
    const double width = kSmall / static_cast<double>(rows.front().size());
    const double height = size.height_px * scale / static_cast<double>(rows.size());
    double most = 1;
    for (const auto& row : rows) most = std::max(most, *std::ranges::max_element(row));
    std::string svg;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            const double x = static_cast<double>(c) * width;
            const double y = static_cast<double>(r) * height;
            const double count = std::max(0.0, rows[r][c]);
            const bool none = count == 0;
            svg += SvgBox(x, y, width, height, none ? "cell empty" : "cell covered",
                          none ? 1 : 0.12 + 0.6 * count / most);
            svg += CellText(x, y, width, height, Short(count));
        }
    }
    return MapFigure(Frame(size, scale, "Coverage", svg),
                     "Corners seen in each part of the picture. Where there is none, the lens is a "
                     "guess.");
}

std::string UncertaintyMap(const json& places, const PictureSize& size) {
    const auto points = Points(places, 3, 0);
    if (points.empty()) return kNotInFile;
    constexpr double kBest_px = 0.03;
    constexpr double kWorst_px = 10;
    const double scale = kSmall / size.width_px;
    const double width = Step(points, 0, size.width_px) * scale;
    const double height = Step(points, 1, size.height_px) * scale;
    std::string svg;
    for (const auto& point : points) {
        const double sigma_px = std::clamp(point[2], kBest_px, kWorst_px);
        const double x = point[0] * scale - width / 2;
        const double y = point[1] * scale - height / 2;
        svg += SvgBox(x, y, width, height, "cell uncertain",
                      0.75 * std::log(sigma_px / kBest_px) / std::log(kWorst_px / kBest_px));
        svg += CellText(x, y, width, height, Short(point[2], 1));
    }
    return MapFigure(Frame(size, scale, "Uncertainty", svg),
                     "How far a distant point may be from where the lens puts it, px, standard "
                     "deviation, after the best turn of the camera. Blank: no ray has a pixel "
                     "there.");
}

std::string ResidualMap(const json& residuals, const PictureSize& size) {
    const auto points = Points(residuals, 5, 1);
    if (points.empty()) return kNotInFile;
    std::vector<double> lengths;
    for (const auto& p : points) lengths.push_back(std::hypot(p[3], p[4]));
    const double typical_px = std::max(1e-6, Percentile(lengths, 0.95));
    const double enlarged = std::max(1.0, RoundBelow(size.width_px * 0.03 / typical_px));
    const double scale = kLarge / size.width_px;
    const std::size_t step = 1 + points.size() / kMostDrawn;
    std::string svg;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const auto& p = points[i];
        const double x = p[1] * scale;
        const double y = p[2] * scale;
        svg += SvgLine(x, y, x + p[3] * enlarged * scale, y + p[4] * enlarged * scale, "vector");
        svg += SvgDot(x, y, 1.6, "seen");
    }
    const double bar_px = RoundBelow(typical_px);
    const double bar = bar_px * enlarged * scale;
    const double bottom = size.height_px * scale - 12;
    svg += SvgLine(12, bottom, 12 + bar, bottom, "ruler");
    svg += SvgText(12, bottom - 6, "start", Short(bar_px) + " px");
    return MapFigure(
        Frame(size, scale, "Residuals", svg),
        "From each seen corner (dot) towards where lens and board put it, enlarged " +
            Short(enlarged) + " times. " + std::to_string(points.size()) + " corners" +
            (step > 1 ? ", one of " + std::to_string(step) + " drawn" : std::string()) +
            "; 95 % are off by less than " + Short(typical_px, 3) +
            " px. They should look like noise: a pattern is what lens or board do not explain.");
}

}  // namespace hitchview::app
