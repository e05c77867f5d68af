#pragma once

#include <optional>
#include <string>

#include "calib/rig_calibration.hpp"
#include "calib/unit_session.hpp"
#include "calib/unit_solver.hpp"

namespace hitchview::calib {

/// Why cameras of a session cannot stand beside those of a rig: another vehicle, or a name that a
/// camera of the other unit has. Empty: they can.
std::string WhyNotInto(const RigCalibration& rig, const UnitSession& session);

/// The rig with the session's unit in place of what it had of that unit; of one unit alone where
/// there is no rig. It passes only if the unit and all that it had of the other unit passed: the
/// verdict is the unit's if it is not pass, otherwise the rig's.
RigCalibration WithUnit(const std::optional<RigCalibration>& rig, const UnitSession& session,
                        const UnitSolution& solution, Verdict verdict,
                        const std::string& written_by);

}  // namespace hitchview::calib
