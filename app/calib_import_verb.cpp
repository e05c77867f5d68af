#include <algorithm>
#include <cstdio>
#include <numbers>

#include "app/calib_formats_verb.hpp"
#include "app/calib_provenance.hpp"
#include "app/exit_code.hpp"
#include "calib/format_rig.hpp"
#include "calib/lens_file.hpp"
#include "hal/result.hpp"

namespace hitchview::app {
namespace {

hal::Checked<algo::Unit> UnitOf(const CalibImportOptions& options, std::size_t file) {
    if (options.units.size() > 1 && options.units.size() != options.in.size())
        return "--unit is given " + std::to_string(options.units.size()) +
               " times, must be given once or for each of the " +
               std::to_string(options.in.size()) + " files";
    const std::string& name = options.units[options.units.size() > 1 ? file : 0];
    for (const algo::Unit unit : algo::kUnits) {
        if (algo::ToString(unit) == name) return unit;
    }
    return "--unit is " + name + ", must be tractor or trailer";
}

std::string Names(const std::vector<calib::ForeignCamera>& cameras) {
    std::string names;
    for (const calib::ForeignCamera& camera : cameras)
        names.append(names.empty() ? "" : ", ").append(camera.name);
    return names;
}

/// The cameras of one file, or of these the one that is asked for.
hal::Checked<calib::ForeignCameras> Cameras(const CalibImportOptions& options, std::size_t file) {
    calib::ForeignCameras found =
        calib::ImportCameras(options.format, options.in[file], options.hints);
    if (!found.error.empty()) return found.error;
    if (options.camera.empty()) return found;
    const std::string names = Names(found.cameras);
    std::erase_if(found.cameras, [&](const auto& camera) { return camera.name != options.camera; });
    if (found.cameras.empty())
        return options.in[file].string() + ": has no camera " + options.camera +
               ", must be one of " + names;
    return found;
}

hal::Checked<std::vector<calib::UnitCameras>> AllCameras(const CalibImportOptions& options) {
    std::vector<calib::UnitCameras> all;
    for (std::size_t i = 0; i < options.in.size(); ++i) {
        auto cameras = Cameras(options, i);
        if (!cameras) return cameras.error();
        all.push_back({.file = options.in[i].string(), .foreign = std::move(*cameras)});
        if (options.units.empty()) continue;
        const auto unit = UnitOf(options, i);
        if (!unit) return unit.error();
        all.back().unit = unit.value();
    }
    return all;
}

void Print(const std::string& name, const algo::CameraModel& m) {
    std::printf(
        "%-16s %s %dx%d, focal %.2f %.2f, centre %.2f %.2f px, %.1f degrees from the axis\n",
        name.c_str(), std::string(ToString(m.kind)).c_str(), m.width_px, m.height_px, m.fx_px,
        m.fy_px, m.cx_px, m.cy_px, m.max_theta_rad * 180 / std::numbers::pi);
}

int ImportLens(const CalibImportOptions& options, const std::vector<calib::UnitCameras>& files) {
    const std::vector<calib::ForeignCamera>& cameras = files.front().foreign.cameras;
    if (files.size() > 1)
        return Fail(kWrongUse, "--in names " + std::to_string(files.size()) +
                                   " files, must be one for a lens; --unit makes a rig of several");
    if (cameras.size() > 1)
        return Fail(kWrongUse, files.front().file + ": has the cameras " + Names(cameras) +
                                   ", must be one for a lens: choose it with --camera; --unit "
                                   "makes a rig of all");
    const std::string problem =
        calib::SaveUncheckedLens(cameras.front().model, WrittenBy(options.command), options.out);
    if (!problem.empty()) return Fail(kMachineFailed, problem);
    Print(cameras.front().name, cameras.front().model);
    return 0;
}

int ImportRig(const CalibImportOptions& options, const std::vector<calib::UnitCameras>& files) {
    const auto T_unit_first = calib::ParseCameraPlace(options.first_camera);
    if (!options.first_camera.empty() && !T_unit_first)
        return Fail(kWrongUse, "--first-camera is " + options.first_camera +
                                   ", must be X,Y,Z,ROLL,PITCH,YAW in metres and degrees");
    calib::AssembledRig rig = calib::AssembleRig(files, options.vehicle, T_unit_first);
    if (!rig.calibration) return Fail(kWrongUse, rig.error);
    rig.calibration->written_by = WrittenBy(options.command);
    const std::string problem = calib::SaveCalibration(*rig.calibration, options.out);
    if (!problem.empty()) return Fail(kMachineFailed, problem);
    for (const auto& [name, camera] : rig.calibration->cameras) Print(name, camera.model);
    return 0;
}

}  // namespace

int CalibImportVerb(const CalibImportOptions& options) {
    const auto files = AllCameras(options);
    if (!files) return Fail(kWrongUse, files.error());
    return options.units.empty() ? ImportLens(options, files.value())
                                 : ImportRig(options, files.value());
}

}  // namespace hitchview::app
