#include "app/calib_report.hpp"

#include "app/calib_report_json.hpp"
#include "app/calib_report_lens.hpp"
#include "app/calib_report_style.hpp"
#include "app/calib_report_svg.hpp"
#include "app/calib_report_unit.hpp"
#include "app/calib_report_verify.hpp"
#include "app/html_report.hpp"
#include "app/html_report_style.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

enum class PartKind { kLens, kUnit, kVerify, kOther };

/// A chapter of the report: a lens, a unit or the checks.
struct Chapter {
    PartKind kind = PartKind::kOther;
    std::string name{};
    const ReportSource* source = nullptr;  ///< borrowed, as is the next
    const json* content = nullptr;
};

PartKind KindOf(const json& content) {
    const std::string verb = TextIn(content, "verb");
    if (verb == "intrinsics" || (verb.empty() && Part(content, "lens").is_object()))
        return PartKind::kLens;
    if (verb == "verify" || (verb.empty() && Part(content, "checks").is_array()))
        return PartKind::kVerify;
    if (verb == "unit" || (verb.empty() && !Part(content, "cameras").is_null()))
        return PartKind::kUnit;
    return PartKind::kOther;
}

/// `intrinsics` has written one lens, or those of several cameras.
std::vector<Chapter> ChaptersOf(const ReportSource& source) {
    const PartKind kind = KindOf(source.content);
    const json& cameras = Part(source.content, "cameras");
    if (kind != PartKind::kLens || !cameras.is_object())
        return {{kind, source.file.stem().string(), &source, &source.content}};
    std::vector<Chapter> chapters;
    for (const auto& [name, lens] : NamedParts(cameras))
        chapters.push_back({kind, name, &source, lens});
    return chapters;
}

std::string Title(const Chapter& chapter) {
    switch (chapter.kind) {
        case PartKind::kLens:
            return "Lens of " + chapter.name;
        case PartKind::kUnit: {
            const std::string unit = TextIn(*chapter.content, "unit");
            return "Cameras of the " + (unit.empty() ? "unit " + chapter.name : unit);
        }
        case PartKind::kVerify:
            return "Checks of " + chapter.name;
        case PartKind::kOther:
            break;
    }
    const std::string verb = TextIn(*chapter.content, "verb");
    return chapter.name + (verb.empty() ? "" : ", " + verb);
}

std::string Summary(const Chapter& chapter) {
    switch (chapter.kind) {
        case PartKind::kLens:
            return LensSummary(*chapter.content);
        case PartKind::kUnit:
            return UnitSummary(*chapter.content);
        case PartKind::kVerify:
            return VerifySummary(*chapter.content);
        case PartKind::kOther:
            break;
    }
    return "";
}

/// Of a file that no chapter is made for: what stands at its top.
std::string OtherReport(const json& content) {
    std::string rows;
    if (content.is_object()) {
        for (const auto& [key, value] : content.items()) {
            if (value.is_primitive()) {
                const auto number = NumberOf(value);
                rows += HtmlRow({key, number              ? Short(*number, 6)
                                      : value.is_string() ? value.get<std::string>()
                                                          : value.dump()});
            }
        }
    }
    return rows.empty() ? kNotInFile : HtmlTable("Figures", {"", ""}, rows);
}

std::string Content(const Chapter& chapter) {
    const std::filesystem::path folder = chapter.source->file.parent_path();
    switch (chapter.kind) {
        case PartKind::kLens:
            return LensReport(*chapter.content);
        case PartKind::kUnit:
            return UnitReport(*chapter.content, folder);
        case PartKind::kVerify:
            return VerifyReport(*chapter.content, folder);
        case PartKind::kOther:
            break;
    }
    return OtherReport(*chapter.content);
}

std::string Reasons(const json& content) {
    std::string items;
    for (const std::string& reason : TextsOf(Part(content, "reasons")))
        items += "<li>" + Escaped(reason) + "</li>";
    return items.empty() ? "" : "<ul class=\"reasons\">" + items + "</ul>";
}

std::string Overview(const std::vector<Chapter>& chapters) {
    std::string rows;
    for (const Chapter& chapter : chapters) {
        rows += "<tr>" + Cell(Title(chapter)) + "<td>" +
                Badge(TextIn(*chapter.content, "verdict")) + "</td><td>" +
                Escaped(Summary(chapter)) + Reasons(*chapter.content) + "</td></tr>";
    }
    return HtmlTable("Verdicts", {"", "", ""}, rows);
}

std::string Section(const Chapter& chapter) {
    return "<section><h2>" + Escaped(Title(chapter)) + " " +
           Badge(TextIn(*chapter.content, "verdict")) + "</h2>" + Reasons(*chapter.content) +
           Content(chapter) + "</section>\n";
}

std::string Provenance(const std::vector<ReportSource>& sources, const std::string& written_by) {
    const auto or_not = [](const std::string& text) {
        return text.empty() ? std::string("not in this file") : text;
    };
    std::string rows;
    for (const ReportSource& source : sources) {
        const std::string command = TextIn(source.content, "command");
        rows += HtmlRow({source.file.string(), source.sha256.substr(0, 12),
                         or_not(command.empty() ? TextIn(source.content, "written_by") : command),
                         or_not(TextIn(source.content, "date"))});
    }
    return "<section class=\"provenance\"><h2>Where it comes from</h2>" +
           HtmlTable("Files", {"file", "SHA-256", "command", "date"}, rows) + "<p>" +
           Escaped(written_by) + "</p></section>\n";
}

}  // namespace

std::string CalibReport(const std::vector<ReportSource>& sources, const std::string& written_by) {
    std::vector<Chapter> chapters;
    for (const ReportSource& source : sources) {
        for (Chapter& chapter : ChaptersOf(source)) chapters.push_back(std::move(chapter));
    }
    std::string body = "<header><h1>Calibration report</h1></header>\n" + Overview(chapters);
    for (const Chapter& chapter : chapters) body += Section(chapter);
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
           "<title>Calibration report</title><style>" +
           std::string(kStyle) + kCalibReportStyle + "</style></head>\n<body>\n" + body +
           Provenance(sources, written_by) + "</body></html>\n";
}

}  // namespace hitchview::app
