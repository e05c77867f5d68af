#include "app/calib_report_svg.hpp"

#include <array>
#include <cstdio>

#include "app/html_report.hpp"

namespace hitchview::app {
namespace {

std::string Attribute(const char* name, double value) {
    return std::string(" ") + name + "=\"" + Number(value, 1) + "\"";
}

std::string Attribute(const char* name, std::string_view value) {
    return std::string(" ") + name + "=\"" + std::string(value) + "\"";
}

}  // namespace

std::string Short(double number, int digits) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*g", digits, number);
    return text.data();
}

std::string SvgLine(double x1, double y1, double x2, double y2, std::string_view css_class) {
    return "<line" + Attribute("x1", x1) + Attribute("y1", y1) + Attribute("x2", x2) +
           Attribute("y2", y2) + Attribute("class", css_class) + "/>";
}

std::string SvgText(double x, double y, std::string_view anchor, const std::string& text) {
    return "<text" + Attribute("x", x) + Attribute("y", y) + Attribute("text-anchor", anchor) +
           ">" + Escaped(text) + "</text>";
}

std::string SvgDot(double x, double y, double radius, std::string_view css_class) {
    return "<circle" + Attribute("cx", x) + Attribute("cy", y) + Attribute("r", radius) +
           Attribute("class", css_class) + "/>";
}

std::string SvgBox(double x, double y, double width, double height, std::string_view css_class,
                   double opacity) {
    return "<rect" + Attribute("x", x) + Attribute("y", y) + Attribute("width", width) +
           Attribute("height", height) + Attribute("class", css_class) + " fill-opacity=\"" +
           Number(opacity, 3) + "\"/>";
}

std::string Svg(double width, double height, const std::string& title, const std::string& content) {
    return "<svg viewBox=\"0 0 " + Number(width, 0) + ' ' + Number(height, 0) +
           "\" role=\"img\" aria-label=\"" + Escaped(title) + "\">" + content + "</svg>";
}

std::string Cell(const std::string& text) {
    return "<td>" + Escaped(text) + "</td>";
}

std::string HtmlRow(const std::vector<std::string>& texts) {
    std::string row = "<tr>";
    for (const std::string& text : texts) row += Cell(text);
    return row + "</tr>";
}

std::string HtmlTable(const std::string& caption, const std::vector<std::string>& head,
                      const std::string& rows) {
    std::string html = "<table><caption>" + Escaped(caption) + "</caption><thead><tr>";
    for (const std::string& text : head) html += "<th>" + Escaped(text) + "</th>";
    return html + "</tr></thead><tbody>" + rows + "</tbody></table>";
}

std::string Badge(const std::string& verdict) {
    const char* const colour = verdict == "pass" ? "good" : verdict == "fail" ? "poor" : "open";
    return std::string("<span class=\"badge ") + colour + "\">" +
           Escaped(verdict.empty() ? "no verdict" : verdict) + "</span>";
}

}  // namespace hitchview::app
