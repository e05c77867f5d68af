#pragma once

#include <filesystem>

#include "app/doctor.hpp"

namespace hitchview::app {

struct DoctorOptions {
    std::filesystem::path rig{};  ///< whose needs are checked; empty: the installed one
    bool json = false;            ///< for scripts, instead of the table
};

/// What is asked about a rig, in its order. Where there is none, or it is broken, the checks that
/// depend on what is in it say so.
std::vector<DoctorCheck> AllChecks(const DoctorCase& subject);

/// Is this machine ready? Exit code: 0 it is; 1 something is bad, an installed rig file too; 2 the
/// rig file that was given is; 3 the answer cannot be written.
int DoctorVerb(const DoctorOptions& options);

}  // namespace hitchview::app
