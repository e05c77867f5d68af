#include "app/calib_target_verb.hpp"

#include <cstdio>
#include <map>
#include <string>

#include "app/calib_sheet.hpp"
#include "app/exit_code.hpp"
#include "calib/replace_file.hpp"

namespace hitchview::app {
namespace {

std::string Save(const TargetOptions& options, const SheetPlan& plan, SheetFormat format) {
    const auto file = SheetFile(plan, format);
    if (!file) return file.error();
    const auto accept = [](const std::filesystem::path&) { return std::string(); };
    std::string problem = calib::ReplaceFile(options.out, file.value().bytes, accept);
    if (problem.empty() && !options.board_out.empty())
        problem = calib::SaveBoard(plan.board, options.board_out);
    return problem;
}

}  // namespace

CLI::App& AddTarget(CLI::App& app, TargetOptions& options) {
    using calib::Pattern;
    CLI::App& verb = *app.add_subcommand(
        "target",
        "Print a board: a sheet at its exact size, with a bar to measure after printing.\n"
        "What is not given is chosen so that the paper is filled.\n"
        "Example: hitchview-calib target --pattern charuco --paper a2 --out sheet.pdf "
        "--board-out board.yaml");
    SheetRequest& sheet = options.sheet;
    verb.add_option("--pattern", sheet.pattern, "checkerboard, charuco or tags (charuco)")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, Pattern>{{"checkerboard", Pattern::kCheckerboard},
                                           {"charuco", Pattern::kCharuco},
                                           {"tags", Pattern::kTags}}));
    verb.add_option("--columns", sheet.columns, "inner corners in a row, or tags");
    verb.add_option("--rows", sheet.rows, "inner corners in a column, or tags");
    verb.add_option("--square-m", sheet.square_m, "side of a square; from tag to tag");
    verb.add_option("--tag-m", sheet.tag_m, "side of a tag's black frame");
    verb.add_option("--first-tag", sheet.first_tag, "number of the first tag (0)");
    verb.add_option("--paper", sheet.paper, "a4 to a0, or WIDTHxHEIGHT in mm (a4)");
    verb.add_option("--out", options.out, "sheet to write, .pdf or .svg")->required();
    verb.add_option("--board-out", options.board_out, "board file to write, for --board");
    return verb;
}

int TargetVerb(const TargetOptions& options) {
    const std::string extension = options.out.extension().string();
    if (extension != ".pdf" && extension != ".svg")
        return Fail(kWrongUse, "--out is " + options.out.string() + ", must end in .pdf or .svg");
    const auto plan = PlanSheet(options.sheet);
    if (!plan) return Fail(kWrongUse, plan.error());
    const std::string problem =
        Save(options, plan.value(), extension == ".pdf" ? SheetFormat::kPdf : SheetFormat::kSvg);
    if (!problem.empty()) return Fail(kMachineFailed, problem);
    std::printf("%s\n", calib::Describe(plan.value().board).c_str());
    return 0;
}

}  // namespace hitchview::app
