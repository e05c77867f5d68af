#include "app/calib_verify_report.hpp"

#include <algorithm>
#include <cstdio>

namespace hitchview::app {

using nlohmann::json;

bool VerifyFindings::AreGood() const {
    return std::ranges::all_of(checks, &calib::Check::ok);
}

json VerifyJson(const VerifyFindings& findings, const calib::RigCalibration& calibration,
                const std::string& file) {
    json checks = json::array();
    json reasons = json::array();
    for (const calib::Check& check : findings.checks) {
        checks.push_back({{"name", check.name},
                          {"figure", check.figure},
                          {"limit", check.limit ? json(*check.limit) : json(nullptr)},
                          {"unit", check.unit},
                          {"ok", check.ok},
                          {"reason", check.reason}});
        if (!check.ok) reasons.push_back(check.name + ": " + check.reason);
    }
    json pictures = json::array();
    for (const auto& [title, path] : findings.pictures)
        pictures.push_back({{"title", title}, {"path", path}});
    return {{"verb", "verify"},
            {"vehicle", calibration.vehicle},
            {"calibration", file},
            {"calibration_id", calibration.id()},
            {"verdict", findings.AreGood() ? "pass" : "fail"},
            {"reasons", reasons},
            {"checks", checks},
            {"pictures", pictures}};
}

void PrintVerify(const VerifyFindings& findings) {
    for (const calib::Check& check : findings.checks) {
        std::printf("%-5s %s: %.2f %s", check.ok ? "good" : "BAD", check.name.c_str(), check.figure,
                    check.unit.c_str());
        if (check.limit) std::printf(" (at most %.2f)", *check.limit);
        std::printf("%s%s\n", check.reason.empty() ? "" : "; ", check.reason.c_str());
    }
    std::printf("verdict: %s\n", findings.AreGood() ? "pass" : "fail");
}

}  // namespace hitchview::app
