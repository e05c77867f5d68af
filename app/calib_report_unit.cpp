#include "app/calib_report_unit.hpp"

#include "app/calib_report_graph.hpp"
#include "app/calib_report_json.hpp"
#include "app/calib_report_plan.hpp"
#include "app/calib_report_svg.hpp"
#include "app/calib_report_verify.hpp"
#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr double k95 = 1.96;  // standard deviations

/// Three numbers with their intervals: `1.200 +- 0.003`.
std::vector<std::string> WithIntervals(const json& camera, const std::string& value,
                                       const std::string& sigma, int decimals) {
    const std::vector<double> numbers = NumbersOf(Part(camera, value));
    const std::vector<double> sigmas = NumbersOf(Part(camera, sigma));
    std::vector<std::string> texts(3, "not in this file");
    for (std::size_t i = 0; i < 3 && numbers.size() == 3; ++i) {
        texts[i] = Number(numbers[i], decimals);
        if (sigmas.size() == 3)
            texts[i] += "\u00a0\u00b1\u00a0" + Number(k95 * sigmas[i], decimals);
    }
    return texts;
}

std::string PlaceTable(const json& cameras) {
    std::string rows;
    for (const auto& [name, camera] : NamedParts(cameras)) {
        std::vector<std::string> texts{name};
        for (std::string& text : WithIntervals(*camera, "position_m", "position_sigma_m", 4))
            texts.push_back(std::move(text));
        for (std::string& text : WithIntervals(*camera, "rpy_deg", "rpy_sigma_deg", 3))
            texts.push_back(std::move(text));
        const auto rms_px = NumberIn(*camera, "rms_px");
        texts.push_back(rms_px ? Short(*rms_px, 3) : "");
        rows += HtmlRow(texts);
    }
    if (rows.empty()) return kNotInFile;
    return HtmlTable(
        "Where each camera stands; \u00b1 is the 95 % interval",
        {"camera", "x m", "y m", "z m", "roll \u00b0", "pitch \u00b0", "yaw \u00b0", "rms px"},
        rows);
}

/// `front - left`.
std::string PairName(const json& pair) {
    const std::vector<std::string> cameras = TextsOf(Part(pair, "cameras"));
    return cameras.size() == 2 ? cameras[0] + " - " + cameras[1] : "";
}

std::string FarTable(const json& pairs) {
    if (!pairs.is_array() || pairs.empty()) return kNotInFile;
    std::string rows;
    for (const json& pair : pairs) {
        std::vector<std::string> texts{PairName(pair)};
        for (const char* const key : {"before_px", "after_px", "matches"}) {
            const auto number = NumberIn(pair, key);
            texts.push_back(number ? Short(*number, 3) : "not in this file");
        }
        rows += HtmlRow(texts);
    }
    return HtmlTable("How far neighbours disagree on what is far away, in a panorama of 4096 px",
                     {"cameras", "with targets alone, px", "now, px", "matches"}, rows);
}

std::string Notes(const json& notes) {
    std::string html;
    for (const std::string& note : TextsOf(notes)) html += "<li>" + Escaped(note) + "</li>";
    return html.empty() ? "" : "<ul class=\"lead\">" + html + "</ul>";
}

/// What the file names at any level under `view_png`, `before_png` and `after_png`.
std::string Pictures(const json& unit, const std::filesystem::path& folder) {
    std::string html;
    const auto add = [&](const json& part, const std::string& whose) {
        const std::string of = whose.empty() ? "" : ", " + whose;
        for (const auto& [key, title] :
             {std::pair{"view_png", "View"}, std::pair{"before_png", "Before"},
              std::pair{"after_png", "After"}}) {
            if (const std::string path = TextIn(part, key); !path.empty())
                html += ReportPicture(folder / path, title + of);
        }
    };
    add(unit, "");
    add(Part(unit, "pictures"), "");
    for (const auto& [name, camera] : NamedParts(Part(unit, "cameras"))) add(*camera, name);
    for (const auto& [name, pair] : NamedParts(Part(unit, "far"))) add(*pair, PairName(*pair));
    return html.empty() ? kNotInFile : "<div class=\"pictures\">" + html + "</div>";
}

}  // namespace

std::string UnitReport(const json& unit, const std::filesystem::path& folder) {
    return "<h4>Places</h4>" + PlaceTable(Part(unit, "cameras")) + "<h4>From above</h4>" +
           PlanView(Part(unit, "cameras")) + "<h4>Who saw what</h4>" +
           SightingGraph(Part(unit, "sightings")) + Notes(Part(unit, "notes")) +
           "<h4>Far away</h4>" + FarTable(Part(unit, "far")) + "<h4>Pictures</h4>" +
           Pictures(unit, folder);
}

std::string UnitSummary(const json& unit) {
    const std::size_t cameras = NamedParts(Part(unit, "cameras")).size();
    const auto sigma_px = NumberIn(unit, "sigma_px");
    return std::to_string(cameras) + " cameras" +
           (sigma_px ? ", corners found to " + Short(*sigma_px, 3) + " px" : std::string());
}

}  // namespace hitchview::app
