#include "app/calib_report_verb.hpp"

#include <cstdio>
#include <fstream>
#include <optional>

#include "app/calib_provenance.hpp"
#include "app/calib_report.hpp"
#include "app/exit_code.hpp"
#include "calib/replace_file.hpp"
#include "calib/sha256.hpp"
#include "hal/result.hpp"

namespace hitchview::app {
namespace {

constexpr std::size_t kMaxFileBytes = 64 << 20;

std::optional<std::string> FileText(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error) ||
        std::filesystem::file_size(file, error) > kMaxFileBytes)
        return std::nullopt;
    std::ifstream stream(file, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    return stream.bad() || !stream.is_open() ? std::nullopt : std::optional(std::move(text));
}

hal::Checked<ReportSource> Load(const std::filesystem::path& file) {
    const auto text = FileText(file);
    if (!text) return file.string() + ": cannot be read, must be a file of at most 64 MiB";
    ReportSource source{.file = file,
                        .sha256 = calib::Sha256(*text),
                        .content = nlohmann::json::parse(*text, nullptr, false)};
    if (!source.content.is_object())
        return file.string() + ": is no JSON map, must be what --json of another verb has written";
    return source;
}

}  // namespace

CLI::App& AddCalibReport(CLI::App& app, CalibReportOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "report",
        "Make one page of the figures that other verbs have written with --json.\n"
        "Example: hitchview-calib report --json front.json rear.json tractor.json --out "
        "report.html");
    verb.add_option("--json", options.json, "files of intrinsics, unit, verify")->required();
    verb.add_option("--out", options.out, "HTML page to write")->required();
    return verb;
}

int CalibReportVerb(const CalibReportOptions& options) {
    std::vector<ReportSource> sources;
    for (const std::filesystem::path& file : options.json) {
        auto source = Load(file);
        if (!source) return Fail(kWrongUse, source.error());
        sources.push_back(std::move(source.value()));
    }
    const std::string html = CalibReport(sources, WrittenBy(options.command));
    const std::string problem =
        calib::ReplaceFile(options.out, html, [](const auto&) { return std::string(); });
    return problem.empty() ? 0 : Fail(kMachineFailed, problem);
}

}  // namespace hitchview::app
