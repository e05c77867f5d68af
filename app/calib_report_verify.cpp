#include "app/calib_report_verify.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/calib_report_json.hpp"
#include "app/calib_report_svg.hpp"
#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

std::string WithUnit(const json& check, const char* key) {
    const auto number = NumberIn(check, key);
    if (!number) return TextIn(check, key);
    const std::string unit = TextIn(check, "unit");
    return Short(*number) + (unit.empty() ? "" : " " + unit);
}

std::string CheckRow(const json& check) {
    const json& ok = Part(check, "ok");
    const char* const verdict = !ok.is_boolean() ? "" : ok.get<bool>() ? "pass" : "fail";
    return "<tr>" + Cell(TextIn(check, "name")) + Cell(WithUnit(check, "figure")) +
           Cell(WithUnit(check, "limit")) + "<td>" + Badge(verdict) + "</td>" +
           Cell(TextIn(check, "reason")) + "</tr>";
}

std::string Checks(const json& checks) {
    if (!checks.is_array() || checks.empty()) return kNotInFile;
    std::string rows;
    for (const json& check : checks) rows += CheckRow(check);
    return HtmlTable("Checks", {"check", "figure", "limit", "", "reason"}, rows);
}

std::string Pictures(const json& pictures, const std::filesystem::path& folder) {
    if (!pictures.is_array() || pictures.empty()) return kNotInFile;
    std::string html;
    for (const json& picture : pictures)
        html += ReportPicture(folder / TextIn(picture, "path"), TextIn(picture, "title"));
    return "<div class=\"pictures\">" + html + "</div>";
}

/// Empty if it is no picture.
cv::Mat Load(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return {};
    try {
        return cv::imread(file.string(), cv::IMREAD_COLOR);
    } catch (const cv::Exception&) {
        return {};  // a header that promises more than memory holds
    }
}

}  // namespace

std::string VerifyReport(const json& verify, const std::filesystem::path& folder) {
    return Checks(Part(verify, "checks")) + "<h4>Pictures</h4>" +
           Pictures(Part(verify, "pictures"), folder);
}

std::string VerifySummary(const json& verify) {
    const json& checks = Part(verify, "checks");
    if (!checks.is_array()) return "";
    const auto good =
        std::ranges::count_if(checks, [](const json& check) { return Part(check, "ok") == true; });
    return std::to_string(good) + " of " + std::to_string(checks.size()) + " checks good";
}

std::string ReportPicture(const std::filesystem::path& file, const std::string& title) {
    constexpr double kWidest_px = 1600;
    cv::Mat picture = Load(file);
    if (picture.empty())
        return "<p class=\"none\">" +
               Escaped(title + ": " + file.string() + " is no picture that can be read") + "</p>";
    const double scale = std::min(1.0, kWidest_px / picture.cols);
    if (scale < 1) cv::resize(picture, picture, {}, scale, scale, cv::INTER_AREA);
    return Figure(picture, title);
}

}  // namespace hitchview::app
