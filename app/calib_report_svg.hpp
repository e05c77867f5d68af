#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Words of SVG and HTML that the parts of a calibration report share. Texts are escaped here.
namespace hitchview::app {

/// What stands where a file does not have a part.
inline constexpr const char* kNotInFile = "<p class=\"none\">not in this file</p>";

/// `%.*g`: as many digits as tell something.
std::string Short(double number, int digits = 4);

std::string SvgLine(double x1, double y1, double x2, double y2, std::string_view css_class);
std::string SvgText(double x, double y, std::string_view anchor, const std::string& text);
std::string SvgDot(double x, double y, double radius, std::string_view css_class);
std::string SvgBox(double x, double y, double width, double height, std::string_view css_class,
                   double opacity = 1);

/// A whole drawing of this size; `title` is what is read aloud.
std::string Svg(double width, double height, const std::string& title, const std::string& content);

/// `<td>` with an escaped text.
std::string Cell(const std::string& text);
/// A table: `head` and `rows` are cells.
std::string HtmlTable(const std::string& caption, const std::vector<std::string>& head,
                      const std::string& rows);
std::string HtmlRow(const std::vector<std::string>& texts);

/// `pass`, `fail` or another word in its colour.
std::string Badge(const std::string& verdict);

}  // namespace hitchview::app
