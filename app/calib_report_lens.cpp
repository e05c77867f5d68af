#include "app/calib_report_lens.hpp"

#include <algorithm>
#include <numbers>

#include "app/calib_report_json.hpp"
#include "app/calib_report_picture.hpp"
#include "app/calib_report_svg.hpp"
#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

struct Parameter {
    std::string name;
    double value;
    int decimals;
};

std::vector<Parameter> Parameters(const json& lens) {
    const std::vector<double> focal = NumbersOf(Part(lens, "focal_px"));
    const std::vector<double> centre = NumbersOf(Part(lens, "centre_px"));
    const std::vector<double> distortion = NumbersOf(Part(lens, "distortion"));
    if (focal.size() != 2 || centre.size() != 2) return {};
    std::vector<Parameter> all{{"focal length x, px", focal[0], 3},
                               {"focal length y, px", focal[1], 3},
                               {"centre x, px", centre[0], 3},
                               {"centre y, px", centre[1], 3}};
    const std::vector<std::string> names =
        TextIn(lens, "model") == "pinhole_radtan"
            ? std::vector<std::string>{"k1", "k2", "p1", "p2", "k3"}
            : std::vector<std::string>{"k1", "k2", "k3", "k4"};
    for (std::size_t i = 0; i < std::min(distortion.size(), names.size()); ++i)
        all.push_back({names[i], distortion[i], 6});
    return all;
}

std::string ParameterTable(const json& lens) {
    constexpr double k95 = 1.96;  // standard deviations
    const std::vector<Parameter> parameters = Parameters(lens);
    if (parameters.empty()) return kNotInFile;
    const std::vector<double> sigma = NumbersOf(Part(lens, "sigma"));
    std::string rows;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const Parameter& p = parameters[i];
        std::vector<std::string> texts{p.name, Number(p.value, p.decimals), "not determined"};
        if (i < sigma.size()) {
            const double half = k95 * sigma[i];
            texts[1] += "\u00a0\u00b1\u00a0" + Number(half, p.decimals);
            texts[2] =
                Number(p.value - half, p.decimals) + " to " + Number(p.value + half, p.decimals);
        }
        rows += HtmlRow(texts);
    }
    return HtmlTable("Parameters. 95 of 100 such measurements hold the truth in their interval.",
                     {"parameter", "value", "95 % interval"}, rows);
}

std::string OrNot(const std::optional<double>& number, const std::string& unit, double factor = 1) {
    return number ? Short(factor * *number, 3) + unit : "not in this file";
}

std::string FigureTable(const json& report) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    const json& lens = Part(report, "lens");
    const std::vector<double> size = NumbersOf(Part(lens, "size_px"));
    std::string rows;
    rows += HtmlRow({"model", TextIn(lens, "model")});
    if (size.size() == 2)
        rows += HtmlRow({"picture", Number(size[0], 0) + " x " + Number(size[1], 0) + " px"});
    rows += HtmlRow({"pictures looked at", OrNot(NumberIn(report, "pictures"), "")});
    rows += HtmlRow({"views with a board", OrNot(NumberIn(report, "views_found"), "")});
    rows += HtmlRow({"views used", OrNot(NumberIn(report, "views_used"), "")});
    rows += HtmlRow({"error (rms)", OrNot(NumberIn(report, "rms_px"), " px")});
    rows += HtmlRow(
        {"error in views that were left out", OrNot(NumberIn(report, "heldout_rms_px"), " px")});
    rows += HtmlRow({"picture covered", OrNot(NumberIn(report, "covered"), " %", 100)});
    rows += HtmlRow(
        {"most tilt of a board", OrNot(NumberIn(report, "most_tilt_rad"), " degrees", kDegrees)});
    rows += HtmlRow(
        {"field, from the axis", OrNot(NumberIn(lens, "max_theta_rad"), " degrees", kDegrees)});
    const json& board = Part(report, "board");
    rows += HtmlRow({"board", TextIn(board, "shape") + ", farthest corner from its place " +
                                  OrNot(NumberIn(board, "bulge_m"), " mm", 1000)});
    return HtmlTable("Figures", {"", ""}, rows);
}

std::string ViewRow(const json& view, double worst_px) {
    const auto rms_px = NumberIn(view, "rms_px");
    const auto blur_px = NumberIn(view, "blur_px");
    const std::string bar = rms_px ? "<div class=\"bar\" style=\"width:" +
                                         Number(100 * std::clamp(*rms_px / worst_px, 0.0, 1.0), 1) +
                                         "%\"></div>"
                                   : "";
    return "<tr>" + Cell(TextIn(view, "name")) + Cell(rms_px ? Short(*rms_px, 3) : "") +
           "<td class=\"bars\">" + bar + "</td>" + Cell(blur_px ? Short(*blur_px, 3) : "") +
           Cell(TextIn(view, "fate")) + "</tr>";
}

std::string Views(const json& views) {
    if (!views.is_array() || views.empty()) return kNotInFile;
    double worst_px = 1e-9;
    for (const json& view : views)
        worst_px = std::max(worst_px, NumberIn(view, "rms_px").value_or(0));
    std::string rows;
    for (const json& view : views) rows += ViewRow(view, worst_px);
    return HtmlTable("Error of each view", {"view", "rms px", "", "blur px", ""}, rows);
}

}  // namespace

std::string LensReport(const json& report) {
    const json& lens = Part(report, "lens");
    const std::vector<double> given = NumbersOf(Part(lens, "size_px"));
    const bool drawable = given.size() == 2 && given[0] >= 1 && given[1] >= 1 && given[0] <= 1e5 &&
                          given[1] <= 10 * given[0];
    const PictureSize size{drawable ? given[0] : 16, drawable ? given[1] : 9};
    return "<div class=\"pair\"><div>" + FigureTable(report) + "</div><div>" +
           ParameterTable(lens) + "</div></div><div class=\"pair\"><div><h4>Coverage</h4>" +
           CoverageMap(Part(report, "coverage"), size) +
           "</div><div><h4>Uncertainty over the picture</h4>" +
           (drawable ? UncertaintyMap(Part(report, "uncertainty"), size) : kNotInFile) +
           "</div></div><h4>Residuals</h4>" +
           (drawable ? ResidualMap(Part(report, "residuals"), size) : kNotInFile) +
           "<h4>Views</h4>" + Views(Part(report, "views"));
}

std::string LensSummary(const json& report) {
    const auto rms_px = NumberIn(report, "rms_px");
    const auto heldout_px = NumberIn(report, "heldout_rms_px");
    if (!rms_px) return "";
    return Short(*rms_px, 3) + " px" +
           (heldout_px ? ", " + Short(*heldout_px, 3) + " px in views left out" : std::string());
}

}  // namespace hitchview::app
