#include "calib/unit_file.hpp"

namespace hitchview::calib {

std::string WhyNotInto(const RigCalibration& rig, const UnitSession& session) {
    if (rig.vehicle != session.vehicle)
        return "vehicle is '" + session.vehicle + "', must be '" + rig.vehicle +
               "' as in the calibration that the unit goes into";
    for (const UnitCamera& camera : session.problem.cameras) {
        const auto other = rig.cameras.find(camera.name);
        if (other != rig.cameras.end() && other->second.unit != session.unit)
            return "camera " + camera.name + " is one of the " + ToString(other->second.unit) +
                   " in the calibration that the unit goes into, must have another name";
    }
    return "";
}

RigCalibration WithUnit(const std::optional<RigCalibration>& rig, const UnitSession& session,
                        const UnitSolution& solution, Verdict verdict,
                        const std::string& written_by) {
    RigCalibration result = rig.value_or(RigCalibration{.vehicle = session.vehicle});
    std::erase_if(result.cameras,
                  [&](const auto& camera) { return camera.second.unit == session.unit; });
    if (result.cameras.empty() || verdict != Verdict::kPass) result.verdict = verdict;
    result.written_by = written_by;
    for (std::size_t i = 0; i < session.problem.cameras.size(); ++i) {
        const UnitCamera& camera = session.problem.cameras[i];
        result.cameras[camera.name] =
            CalibratedCamera::From(session.unit, {camera.model, solution.cameras[i].T_unit_camera});
    }
    return result;
}

}  // namespace hitchview::calib
