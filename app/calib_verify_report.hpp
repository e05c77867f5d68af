#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "calib/rig_calibration.hpp"
#include "calib/verification.hpp"

namespace hitchview::app {

/// What fresh pictures say about a calibration.
struct VerifyFindings {
    std::vector<calib::Check> checks{};
    std::vector<std::pair<std::string, std::string>> pictures{};  ///< title, file

    [[nodiscard]] bool AreGood() const;
};

/// All figures (docs/calibration-report.md). `file`: of the calibration.
nlohmann::json VerifyJson(const VerifyFindings& findings, const calib::RigCalibration& calibration,
                          const std::string& file);

/// The same for a person, on stdout.
void PrintVerify(const VerifyFindings& findings);

}  // namespace hitchview::app
