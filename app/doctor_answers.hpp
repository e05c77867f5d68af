#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "app/doctor.hpp"

namespace hitchview::app {

/// Of one check; what has not answered by then does not answer.
inline constexpr std::chrono::milliseconds kDoctorPatience{2000};

/// A check and what it found.
struct DoctorAnswer {
    std::string name;
    Diagnosis diagnosis;
};

/// Asks all of them in order. What is bad although a check that it needs is bad too, or comes after
/// such a one, is unknown: of one breakage one check is bad.
std::vector<DoctorAnswer> RunChecks(const std::vector<DoctorCheck>& checks,
                                    std::chrono::milliseconds patience = kDoctorPatience);
/// One line each, its remedy below it.
std::string DoctorTable(const std::vector<DoctorAnswer>& answers);
std::string DoctorJson(const std::vector<DoctorAnswer>& answers);
/// Whether nothing is bad. What cannot be checked is not bad.
bool IsReady(const std::vector<DoctorAnswer>& answers);

}  // namespace hitchview::app
