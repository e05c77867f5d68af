#pragma once

#include <filesystem>

#include "app/doctor.hpp"

namespace hitchview::app {

/// The rig file that a machine is asked about: `given`, or the installed one where it is empty.
DoctorRig ReadRig(const DoctorMachine& machine, const std::filesystem::path& given);

}  // namespace hitchview::app
