#include "app/doctor_rig.hpp"

#include <unistd.h>

#include <system_error>

namespace hitchview::app {
namespace {

using State = DoctorRig::State;

/// A loader's lines as one.
std::string OneLine(std::string text) {
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', end))
        text.replace(end, 1, "; ");
    return text;
}

Diagnosis NoRigFile(const DoctorSubject& subject) {
    const std::string what = std::string("there is no ") + kInstalledRig;
    if (subject.service.unit_file_state != "enabled")
        return {.what = what + ": what a rig file leaves out is checked, or give --rig"};
    return {Finding::kBad, what + ", which the service waits for",
            "write it; docs/rig.example.yaml shows every key, hitchview cameras what there is"};
}

Diagnosis CheckRigFile(const DoctorSubject& subject) {
    const DoctorRig& rig = subject.rig;
    if (rig.state == State::kAbsent) return NoRigFile(subject);
    if (rig.state == State::kBroken) {
        return {Finding::kBad, OneLine(rig.problem),
                "put that line right; docs/rig.example.yaml shows every key"};
    }
    const auto ids = subject.user_ids();
    if (rig.is_installed && ids && !MayAccess(*ids, subject.machine.root, rig.file, R_OK)) {
        return {Finding::kBad, subject.who() + " may not read " + rig.file.string(),
                "chmod go+rX /etc/hitchview; chmod go+r " + rig.file.string()};
    }
    std::size_t cameras = 0;
    for (const algo::Unit unit : algo::kUnits) cameras += rig.config.units[unit].cameras.size();
    return {Finding::kGood, rig.file.string() + ": " + std::to_string(cameras) + " cameras"};
}

/// What differs between the size that is asked of a live camera and that of its calibration.
std::string SizeProblem(const RigConfig& rig, const calib::RigCalibration& calibration) {
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : rig.units[unit].cameras) {
            const auto found = calibration.cameras.find(camera.name);
            if (!camera.IsLive() || camera.live.accept_granted_size ||
                found == calibration.cameras.end())
                continue;
            const algo::CameraModel& model = found->second.model;
            const Size calibrated{model.width_px, model.height_px};
            if (SizeText(calibrated) != SizeText(camera.live.size_px)) {
                return "camera " + camera.name + " is asked for " + SizeText(camera.live.size_px) +
                       ", calibrated for " + SizeText(calibrated);
            }
        }
    }
    return "";
}

Diagnosis Bad(const DoctorSubject& subject, const std::string& what) {
    return {Finding::kBad, OneLine(what),
            "calibrate these cameras again (docs/calibration.md), or name the calibration of this "
            "vehicle in " +
                subject.rig.file.string()};
}

Diagnosis CheckCalibration(const DoctorSubject& subject) {
    const RigConfig& rig = subject.rig.config;
    if (rig.calibration.empty()) return {.what = "a rig on a plane needs no calibration"};
    const auto calibration = LoadCalibrationFor(rig);
    if (!calibration) return Bad(subject, calibration.error());
    const auto ids = subject.user_ids();
    if (subject.rig.is_installed && ids &&
        !MayAccess(*ids, subject.machine.root, rig.calibration, R_OK)) {
        return {Finding::kBad, subject.who() + " may not read " + rig.calibration.string(),
                "chmod go+r " + rig.calibration.string()};
    }
    if (const std::string problem = SizeProblem(rig, calibration.value()); !problem.empty())
        return Bad(subject, rig.calibration.string() + ": " + problem);
    const std::string what = "calibration " + calibration.value().id() + " of " +
                             calibration.value().vehicle + " fits the rig";
    if (calibration.value().verdict == calib::Verdict::kFail)
        return Bad(subject, what + ", but its own verdict is fail");
    return {Finding::kGood, what};
}

}  // namespace

DoctorRig ReadRig(const DoctorMachine& machine, const std::filesystem::path& given) {
    const std::filesystem::path installed = machine.At(kInstalledRig);
    std::error_code missing;
    DoctorRig rig{.file = given.empty() ? installed : given};
    rig.is_installed = given.empty() || std::filesystem::equivalent(given, installed, missing);
    if (given.empty() && !std::filesystem::exists(installed, missing)) return rig;
    auto loaded = LoadRigConfig(rig.file);
    rig.state = loaded ? State::kLoaded : State::kBroken;
    if (loaded) {
        rig.config = std::move(*loaded);
    } else {
        rig.problem = loaded.error();
    }
    return rig;
}

std::vector<DoctorCheck> RigFileChecks(const DoctorCase& subject) {
    return {{"rig_file", [subject] { return CheckRigFile(*subject); }}};
}

std::vector<DoctorCheck> CalibrationChecks(const DoctorCase& subject) {
    return {{"calibration",
             [subject] { return CheckCalibration(*subject); },
             {"rig_file", "camera_formats"}}};
}

}  // namespace hitchview::app
