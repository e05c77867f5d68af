#include "app/eval_verb.hpp"

#include <cstdio>
#include <fstream>

#include "app/evaluation_report.hpp"
#include "app/evaluation_summary.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

enum ExitCode { kDone = 0, kWrongUse = 2, kMachineFailed = 3 };

int Fail(ExitCode code, const std::string& reason) {
    std::fprintf(stderr, "hitchview eval: %s\n", reason.c_str());
    return code;
}

void ShowProgress(int frames) {
    constexpr int kEvery = 25;
    if (frames % kEvery == 0) std::fprintf(stderr, "\r%d frames", frames);
}

void PrintRow(const std::string& part, const std::string& figure, const json& value) {
    const std::string text = value.is_null()           ? "-"
                             : value.is_number_float() ? std::to_string(value.get<double>())
                                                       : value.dump();
    std::printf("%-14s %-38s %12s\n", part.c_str(), figure.c_str(), text.c_str());
}

// `prefix`: what the names of the figures start with.
void PrintFigures(const std::string& part, const json& figures, const std::string& prefix = "") {
    for (const auto& [figure, value] : figures.items()) {
        if (value.is_object()) {
            PrintFigures(part, value, prefix + figure + ".");
        } else {
            PrintRow(part, prefix + figure, value);
        }
    }
}

void PrintTable(const json& report) {
    PrintRow("", "frames", report["frames"]);
    for (const auto& [unit, figures] : report["units"].items()) PrintFigures(unit, figures);
    for (const auto& [seam, figures] : report["seams"].items()) {
        PrintFigures("seam " + seam, figures);
    }
    PrintFigures("panorama", report["panorama"]);
}

int Tabulate(const std::vector<std::string>& files) {
    const auto summary = Summarise(files);
    if (!summary) return Fail(kWrongUse, summary.error());
    std::fputs(summary.value().table.c_str(), stdout);
    return kDone;
}

// True also when there is no file to write.
bool Write(const std::string& text, const std::string& path) {
    if (path.empty()) return true;
    std::ofstream file(path);
    file << text;
    return static_cast<bool>(file.flush());
}

int WriteFiles(const Quality& quality, const EvalOptions& options) {
    if (!Write(quality.figures.dump(2) + '\n', options.json)) {
        return Fail(kMachineFailed, options.json + ": cannot be written");
    }
    if (!options.html.empty() && !Write(HtmlReport(quality), options.html)) {
        return Fail(kMachineFailed, options.html + ": cannot be written");
    }
    return kDone;
}

}  // namespace

int EvalVerb(const EvalOptions& options) {
    if (!options.summary.empty()) return Tabulate(options.summary);
    const auto quality = Evaluate({.units = options.units,
                                   .panorama = options.panorama,
                                   .step = options.step,
                                   .progress = ShowProgress});
    std::fputc('\n', stderr);
    if (!quality) return Fail(kWrongUse, quality.error());
    PrintTable(quality.value().figures);
    return WriteFiles(quality.value(), options);
}

}  // namespace hitchview::app
