#include "app/evaluation_report_series.hpp"

#include <numbers>
#include <vector>

#include "app/evaluation_report_chart.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

// Frame 0, 1, ... in seconds.
std::vector<double> Seconds(std::size_t frames, double rate_hz) {
    std::vector<double> seconds(frames);
    for (std::size_t i = 0; i < frames; ++i) seconds[i] = static_cast<double>(i) / rate_hz;
    return seconds;
}

std::vector<double> Times(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
}

ChartLine PathLine(const json& path, const std::string& component, double factor, double rate_hz) {
    const std::vector<double> values = path[component];
    return {
        .name = {}, .style = {}, .x = Seconds(values.size(), rate_hz), .y = Times(values, factor)};
}

std::string PathChart(const json& unit, const std::string& component, const std::string& title,
                      const std::string& y_label, double factor, double rate_hz) {
    Chart chart{.title = title, .x_label = "s", .y_label = y_label, .lines = {}};
    for (const auto& [when, name, style] :
         {std::tuple("in", "camera", "muted"), std::tuple("out", "stabilised", "first")}) {
        ChartLine line = PathLine(unit[when], component, factor, rate_hz);
        if (line.x.empty()) continue;
        line.name = name;
        line.style = style;
        chart.lines.push_back(line);
    }
    return Draw(chart);
}

// One line of a chart over measured frames. `part`: has `frame` and, at that pointer, `figure`.
ChartLine FrameLine(const json& part, const std::string& figure, double rate_hz,
                    const std::string& name, const std::string& style) {
    return {.name = name,
            .style = style,
            .x = Times(part["frame"], 1 / rate_hz),
            .y = part[json::json_pointer(figure)]};
}

const char* StyleOf(std::size_t line) {
    return line == 0 ? "first" : "second";
}

// `figure`: JSON pointer into a unit's view.
std::string UnitsChart(const json& series, const std::string& figure, const std::string& title) {
    Chart chart{.title = title, .x_label = "s", .y_label = "share", .lines = {}, .highest_y = 1};
    for (const auto& [unit, of_unit] : series["units"].items()) {
        if (of_unit["view"]["frame"].empty()) continue;
        chart.lines.push_back(FrameLine(of_unit["view"], figure, series["rate_hz"], unit,
                                        StyleOf(chart.lines.size())));
    }
    return Draw(chart);
}

}  // namespace

std::string PathCharts(const json& unit, double rate_hz) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    return PathChart(unit, "x_px", "Sideways", "px", 1, rate_hz) +
           PathChart(unit, "y_px", "Up and down (down is positive)", "px", 1, rate_hz) +
           PathChart(unit, "rotation_rad", "Rotation", "degrees", kDegrees, rate_hz);
}

std::string SpectrumChart(const json& unit) {
    Chart chart{.title = "Shake by frequency (the upright line is 1 Hz)",
                .x_label = "Hz",
                .y_label = "amplitude, px",
                .lines = {},
                .logarithmic = true,
                .mark_x = 1};
    for (const auto& [when, name, style] :
         {std::tuple("in", "camera", "muted"), std::tuple("out", "stabilised", "first")}) {
        const json& spectrum = unit[when]["spectrum"];
        if (spectrum["hz"].empty()) continue;
        chart.lines.push_back(
            {.name = name, .style = style, .x = spectrum["hz"], .y = spectrum["amplitude_px"]});
    }
    return Draw(chart);
}

std::string SeamChart(const json& series) {
    Chart chart{.title = "Seam error", .x_label = "s", .y_label = "px", .lines = {}, .lowest_y = 0};
    std::size_t seams = 0;
    for (const auto& [seam, frames] : series["seams"].items()) {
        if (frames["frame"].empty()) continue;
        const std::string style = StyleOf(seams++);
        const double rate_hz = series["rate_hz"];
        chart.lines.push_back(FrameLine(frames, "/p95_px", rate_hz, seam + ", 95 % of the points",
                                        style + " dashed"));
        chart.lines.push_back(FrameLine(frames, "/mean_px", rate_hz, seam + ", mean", style));
    }
    return Draw(chart);
}

std::string ViewCharts(const json& series) {
    Chart coverage{.title = "Canvas covered by the panorama",
                   .x_label = "s",
                   .y_label = "share",
                   .lines = {},
                   .highest_y = 1};
    if (!series["panorama"]["frame"].empty()) {
        coverage.lines.push_back(
            FrameLine(series["panorama"], "/coverage", series["rate_hz"], "panorama", "first"));
    }
    return UnitsChart(series, "/picture/cropping", "Cropping (1: nothing is enlarged)") +
           UnitsChart(series, "/picture/distortion",
                      "Distortion by singular values (1: no stretch, no shear)") +
           UnitsChart(series, "/kept", "Camera's picture kept on the canvas") + Draw(coverage);
}

}  // namespace hitchview::app
