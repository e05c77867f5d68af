#include "app/evaluation_report.hpp"

#include "app/html_report.hpp"
#include "app/evaluation_report_pictures.hpp"
#include "app/evaluation_report_series.hpp"
#include "app/html_report_style.hpp"
#include "app/evaluation_report_tables.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr const char* kNotMeasured = "<p class=\"none\">not measured</p>";

std::string Section(const std::string& title, const std::string& content) {
    return "<section><h2>" + Escaped(title) + "</h2>" + content + "</section>\n";
}

std::string Paragraph(const std::string& text) {
    return "<p>" + Escaped(text) + "</p>";
}

std::string Header(const json& figures) {
    const int frames = figures["frames"];
    const json& series = figures["series"];
    const double rate_hz = series["rate_hz"];
    const int step = series["step"];
    return "<header><h1>Stabilisation and stitching quality</h1><p class=\"lead\">Measured from "
           "the "
           "pixels of the finished recordings: " +
           std::to_string(frames) + " frames, " + Number(frames / rate_hz, 1) + " s at " +
           Number(rate_hz, 2) + " frames a second; " +
           (step == 1 ? std::string("every frame")
                      : "every frame for the paths, one of " + std::to_string(step) +
                            " for cropping, distortion and seams") +
           ".</p></header>\n";
}

std::string Units(const json& figures) {
    std::string html;
    for (const auto& [unit, series] : figures["series"]["units"].items()) {
        html += "<h3>" + Escaped(unit) + "</h3>" +
                PathCharts(series, figures["series"]["rate_hz"]) + SpectrumChart(series);
    }
    return html.empty() ? kNotMeasured : html;
}

std::string WorstSeams(const Quality& quality) {
    std::string html;
    for (const algo::Overlap overlap : algo::kOverlaps) {
        const WorstSeam& seam = quality.worst_seams[overlap];
        if (seam.tractor_grey.empty()) continue;
        html += "<h3>" + std::string(ToString(overlap)) + " seam</h3>" + SeamPictures(seam);
    }
    return html.empty() ? kNotMeasured : html;
}

std::string WorstViews(const Quality& quality) {
    std::string html;
    for (const algo::Unit unit : algo::kUnits) {
        const WorstView& view = quality.worst_views[unit];
        if (view.in_grey.empty()) continue;
        html += "<h3>" + std::string(ToString(unit)) + "</h3>" + ViewPictures(view);
    }
    return html.empty() ? kNotMeasured : html;
}

std::string Body(const Quality& quality) {
    const json& figures = quality.figures;
    const json& series = figures["series"];
    return Header(figures) +
           Section("Beside the published method",
                   Paragraph("The published figures are averages over recordings that are not "
                             "public: the definitions are the same, the scenes are not.") +
                       PaperTables(figures)) +
           Section("All figures", FigureTables(figures)) +
           Section("Where the camera pointed",
                   Paragraph("Path of the picture's centre, summed from frame to frame; the first "
                             "frame is 0. A good result follows the slow course and leaves the "
                             "shake out.") +
                       Units(figures)) +
           Section("Seam error over time",
                   Paragraph("Distance, on the canvas, between the two layers' views of the same "
                             "point. The points are found anew and took no part in the "
                             "alignment.") +
                       SeamChart(series)) +
           Section("Cropping, distortion and coverage over time", ViewCharts(series)) +
           Section("The seams' worst frames", WorstSeams(quality)) +
           Section("The most distorted frames", WorstViews(quality)) +
           Section("What the figures mean", Definitions()) +
           Section("Recordings", RecordingsTable(figures["recordings"]));
}

}  // namespace

std::string HtmlReport(const Quality& quality) {
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
           "<title>Stabilisation and stitching quality</title><style>" +
           std::string(kStyle) + "</style></head>\n<body>\n" + Body(quality) + "</body></html>\n";
}

}  // namespace hitchview::app
