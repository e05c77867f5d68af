#include <cstdio>

#include "app/calib_formats_verb.hpp"
#include "app/exit_code.hpp"
#include "calib/lens_file.hpp"
#include "calib/replace_file.hpp"

namespace hitchview::app {
namespace {

void WarnOf(calib::Verdict verdict, const std::filesystem::path& file) {
    if (verdict == calib::Verdict::kPass) return;
    std::fprintf(stderr, "%s: the verdict is %s, and no other format carries it\n", file.c_str(),
                 std::string(ToString(verdict)).c_str());
}

/// Each in one step, after it could be read back.
int Write(calib::Format format, const calib::ExportedFiles& exported,
          const std::filesystem::path& folder) {
    for (const calib::ForeignFile& file : exported.files) {
        const std::string problem = calib::ReplaceFile(
            folder / file.name, file.text,
            [&](const auto& fresh) { return calib::ImportCameras(format, fresh, {}).error; });
        if (!problem.empty()) return Fail(kMachineFailed, problem);
        std::printf("%s\n", (folder / file.name).c_str());
    }
    return 0;
}

int ExportLens(const CalibExportOptions& options) {
    const calib::LoadedLens lens = calib::LoadLens(options.lens);
    if (!lens.model) return Fail(kWrongUse, lens.error);
    const bool folder = std::filesystem::is_directory(options.out);
    const std::filesystem::path named = folder ? options.lens : options.out;
    calib::ExportedFiles exported =
        calib::ExportLens(options.format, named.stem().string(), *lens.model);
    if (!exported.error.empty())
        return Fail(kWrongUse, options.lens.string() + ": " + exported.error);
    WarnOf(lens.verdict, options.lens);
    if (!folder) exported.files.front().name = options.out.filename();
    return Write(options.format, exported, folder ? options.out : options.out.parent_path());
}

int ExportRig(const CalibExportOptions& options) {
    const calib::LoadedCalibration rig = calib::LoadCalibration(options.calibration);
    if (!rig.calibration) return Fail(kWrongUse, rig.error);
    const calib::ExportedFiles exported = calib::ExportRig(options.format, *rig.calibration);
    if (!exported.error.empty())
        return Fail(kWrongUse, options.calibration.string() + ": " + exported.error);
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (!std::filesystem::is_directory(options.out, error))
        return Fail(kMachineFailed, options.out.string() + ": is no folder and cannot become one");
    WarnOf(rig.calibration->verdict, options.calibration);
    return Write(options.format, exported, options.out);
}

}  // namespace

int CalibExportVerb(const CalibExportOptions& options) {
    if (options.lens.empty() == options.calibration.empty())
        return Fail(kWrongUse, "either --calibration or --lens is needed");
    return options.lens.empty() ? ExportRig(options) : ExportLens(options);
}

}  // namespace hitchview::app
