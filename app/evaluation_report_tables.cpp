#include "app/evaluation_report_tables.hpp"

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "app/evaluation_paper.hpp"
#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr const char* kNotMeasured = "not measured";

// How one figure is shown.
struct Row {
    const char* label;
    const char* pointer;  // JSON pointer to the figure in its part
    double factor;
    int decimals;
    const char* unit;
};

constexpr std::array kUnitRows{
    Row{"Shake left above 1 Hz", "/jitter_ratio", 100, 1, " %"},
    Row{"Jerk, camera", "/jerk_in_px", 1, 2, " px"},
    Row{"Jerk, stabilised", "/jerk_out_px", 1, 2, " px"},
    Row{"Rotation jerk, camera", "/rot_jerk_in_rad", 1000, 2, " mrad"},
    Row{"Rotation jerk, stabilised", "/rot_jerk_out_rad", 1000, 2, " mrad"},
    Row{"Stability, camera", "/paper/stability_in", 1, 4, ""},
    Row{"Stability without pan, camera", "/stability_detrended_in", 1, 4, ""},
    Row{"Stability without pan, stabilised", "/stability_detrended", 1, 4, ""},
    Row{"Cropping of the dominant plane, worst frame", "/cropping_min", 1, 4, ""},
    Row{"Picture kept, mean", "/kept_mean", 100, 1, " %"},
    Row{"Picture kept, worst frame", "/kept_min", 100, 1, " %"},
    Row{"Distortion of the dominant plane, worst frame", "/distortion_min", 1, 4, ""},
    Row{"Distortion of the dominant plane, 1st percentile", "/distortion_p01", 1, 4, ""},
    Row{"Frames that could not be matched", "/frames_unmatched", 1, 0, ""},
    Row{"Frames repeated", "/frames_repeated", 1, 0, ""}};

constexpr std::array kSeamRows{
    Row{"Median", "/median_px", 1, 2, " px"},
    Row{"95 % of the points below", "/p95_px", 1, 2, " px"},
    Row{"Sideways, median", "/horizontal_median_px", 1, 2, " px"},
    Row{"Sideways, 95 % below", "/horizontal_p95_px", 1, 2, " px"},
    Row{"Up and down, median", "/vertical_median_px", 1, 2, " px"},
    Row{"Up and down, 95 % below", "/vertical_p95_px", 1, 2, " px"},
    Row{"Frames with 12 pairs or more", "/measured_share", 100, 1, " %"}};

constexpr std::array kPanoramaRows{
    Row{"Canvas covered, mean", "/coverage_mean", 100, 1, " %"},
    Row{"Canvas covered, worst frame", "/coverage_min", 100, 1, " %"},
    Row{"Largest rectangle covered in all frames", "/common_rectangle_share", 100, 1, " %"},
    Row{"Jerk", "/jerk_px", 1, 2, " px"}, Row{"Stability", "/stability", 1, 4, ""}};

// Column titles and the JSON objects that they show.
using Parts = std::vector<std::pair<std::string, const json*>>;

Parts PartsOf(const json& group, const std::string& behind) {
    Parts parts;
    for (const auto& [name, part] : group.items()) parts.emplace_back(name + behind, &part);
    return parts;
}

std::string Shown(const json& part, const Row& row) {
    const json::json_pointer pointer(row.pointer);
    if (!part.contains(pointer) || !part[pointer].is_number()) return kNotMeasured;
    return Number(row.factor * part[pointer].get<double>(), row.decimals) + row.unit;
}

std::string Cell(const std::string& text, const std::string& style = "") {
    return "<td" + (style.empty() ? "" : " class=\"" + style + "\"") + ">" + Escaped(text) +
           "</td>";
}

std::string Heads(const std::vector<std::string>& titles) {
    std::string html = "<tr>";
    for (const std::string& title : titles) html += "<th scope=\"col\">" + Escaped(title) + "</th>";
    return html + "</tr>";
}

bool AnyShown(const Parts& parts, std::span<const Row> rows) {
    for (const auto& [title, part] : parts) {
        for (const Row& row : rows) {
            if (Shown(*part, row) != kNotMeasured) return true;
        }
    }
    return false;
}

std::string FigureTable(const std::string& caption, const Parts& parts, std::span<const Row> rows) {
    if (!AnyShown(parts, rows)) {
        return "<p class=\"none\">" + Escaped(caption) + ": " + kNotMeasured + "</p>";
    }
    std::vector<std::string> titles{""};
    for (const auto& [title, part] : parts) titles.push_back(title);
    std::string html = "<table><caption>" + Escaped(caption) + "</caption>" + Heads(titles);
    for (const Row& row : rows) {
        html += "<tr>" + Cell(row.label);
        for (const auto& [title, part] : parts) html += Cell(Shown(*part, row));
        html += "</tr>";
    }
    return html + "</table>";
}

// `good`: at least as good as what is published.
std::string Judged(const json& figure, int decimals, const std::string& unit, bool good) {
    if (!figure.is_number()) return Cell(kNotMeasured, "none");
    const std::string text = Number(figure.get<double>(), decimals) + unit;
    return Cell(text + (good ? " \u2713" : " \u25bd"), good ? "good" : "poor");
}

std::string UnitsBesidePaper(const json& units) {
    const Parts parts = PartsOf(units, "");
    std::vector<std::string> titles{"One view: 1 is best", "published"};
    for (const auto& [title, part] : parts) titles.push_back(title);
    std::string html = "<table class=\"headline\">" + Heads(titles);
    for (const PaperFigure& published : kPaperFigures) {
        html += "<tr>" + Cell(published.name) + Cell(Number(published.value, 4));
        for (const auto& [title, part] : parts) {
            const json& figure = (*part)["paper"][published.key];
            const bool good = figure.is_number() && figure.get<double>() >= published.value;
            html += Judged(figure, 4, "", good);
        }
        html += "</tr>";
    }
    return html + "</table>";
}

std::string SeamsBesidePaper(const json& seams) {
    const Parts parts = PartsOf(seams, " seam");
    std::vector<std::string> titles{"Seam: lower is better", "published"};
    for (const auto& [title, part] : parts) titles.push_back(title);
    std::string html =
        "<table class=\"headline\">" + Heads(titles) + "<tr>" + Cell("Stitching score") +
        Cell(Number(kPaperStitchingBestPx, 3) + " to " + Number(kPaperStitchingWorstPx, 3) + " px");
    for (const auto& [title, part] : parts) {
        const json& figure = (*part)["paper"]["stitching_score_px"];
        const bool good = figure.is_number() && figure.get<double>() <= kPaperStitchingWorstPx;
        html += Judged(figure, 3, " px", good);
    }
    return html + "</tr></table>";
}

std::string Definition(const std::string& term, const std::string& meaning) {
    return "<dt>" + Escaped(term) + "</dt><dd>" + Escaped(meaning) + "</dd>";
}

}  // namespace

std::string PaperTables(const json& figures) {
    return UnitsBesidePaper(figures["units"]) + SeamsBesidePaper(figures["seams"]) +
           "<p class=\"lead\">\u2713 as good as published or better, \u25bd not as good.</p>";
}

std::string FigureTables(const json& figures) {
    return FigureTable("Views", PartsOf(figures["units"], ""), kUnitRows) +
           FigureTable("Seams: distance between the layers' views of the same point",
                       PartsOf(figures["seams"], " seam"), kSeamRows) +
           FigureTable("Panorama", {{"panorama", &figures["panorama"]}}, kPanoramaRows);
}

std::string RecordingsTable(const json& recordings) {
    std::string html = "<table class=\"recordings\">";
    for (const auto& [unit, files] : recordings["units"].items()) {
        for (const auto& [which, file] : files.items()) {
            html += "<tr>" + Cell(unit + (which == "in" ? ", camera" : ", stabilised")) +
                    Cell(file.get<std::string>()) + "</tr>";
        }
    }
    if (recordings.contains("panorama")) {
        html +=
            "<tr>" + Cell("panorama") + Cell(recordings["panorama"].get<std::string>()) + "</tr>";
    }
    return html + "</table>";
}

std::string Definitions() {
    return "<dl>" +
           Definition("Cropping",
                      "How much the camera's picture is enlarged: one over the scale of the "
                      "homography from each camera frame to its stabilised frame, at most 1; mean "
                      "over frames.") +
           Definition(
               "Distortion",
               "How unequally it is stretched: ratio of the smaller to the larger eigenvalue "
               "of that homography's linear part, worst frame. The form with "
               "singular values sees a stretch under a rotation too.") +
           Definition("Dominant plane",
                      "The homography may miss a point by 5 px and so describes the whole picture, "
                      "or by 2 px and then only its largest plane. Where near things stand before "
                      "far ones, the largest plane changes from frame to frame: its worst frame "
                      "says more about the fit than about the picture. By singular values.") +
           Definition("Stability",
                      "Share of the path's energy in its 2nd to 6th lowest frequency, mean of "
                      "translation and rotation, re-tracked in the stabilised frames. A long pan "
                      "raises it by itself: hence also the figure without pan.") +
           Definition("Stitching score",
                      "Mean distance between both layers' views of the same points, worst frame.") +
           Definition("Shake left above 1 Hz",
                      "Amplitude of what is faster than 1 Hz in the stabilised path, over that in "
                      "the camera's.") +
           Definition("Jerk", "Root mean square change of the motion from one frame to the next.") +
           Definition("Picture kept",
                      "Share of the camera's picture that lies inside the canvas.") +
           "</dl>";
}

}  // namespace hitchview::app
