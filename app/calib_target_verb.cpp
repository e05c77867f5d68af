#include "app/calib_target_verb.hpp"

#include <cstdio>

#include "app/calib_sheet.hpp"
#include "calib/replace_file.hpp"

namespace hitchview::app {
namespace {

constexpr int kWrongUse = 2;
constexpr int kMachineFailed = 3;

int Fail(int code, const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    return code;
}

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
