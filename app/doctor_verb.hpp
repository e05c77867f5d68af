#pragma once

#include <filesystem>

#include "app/doctor.hpp"

namespace hitchview::app {

struct DoctorOptions {
    std::filesystem::path rig{};  ///< whose needs are checked; empty: a rig file's defaults
    bool json = false;            ///< for scripts, instead of the table
};

/// A check and what it found.
struct DoctorAnswer {
    std::string name;
    Diagnosis diagnosis;
};

std::vector<DoctorAnswer> RunChecks(const std::vector<DoctorCheck>& checks);
/// One line each, its remedy below it.
std::string DoctorTable(const std::vector<DoctorAnswer>& answers);
std::string DoctorJson(const std::vector<DoctorAnswer>& answers);
/// Whether nothing is bad. What cannot be checked is not bad.
bool IsReady(const std::vector<DoctorAnswer>& answers);

/// Is this machine ready? Exit code: 0 it is, 1 something is bad, 2 the rig file is.
int DoctorVerb(const DoctorOptions& options);

}  // namespace hitchview::app
