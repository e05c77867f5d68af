#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/config.hpp"

namespace hitchview::app {

enum class Finding {
    kGood,
    kBad,
    kUnknown,  ///< this check cannot be made here; `what` says why
};

constexpr const char* ToString(Finding finding) {
    switch (finding) {
        case Finding::kGood:
            return "good";
        case Finding::kBad:
            return "bad";
        case Finding::kUnknown:
            return "unknown";
    }
    return "unknown";
}

/// What a check found.
struct Diagnosis {
    Finding finding = Finding::kUnknown;
    std::string what{};    ///< with the figures
    std::string remedy{};  ///< a command or a setting; empty unless kBad
};

/// One question about this machine. Its order in a list is the order it is asked in.
struct DoctorCheck {
    const char* name;  ///< stable: scripts read it
    std::function<Diagnosis()> run;
};

/// Whether panoramas reach subscribers on this machine as `publish` sends them.
std::vector<DoctorCheck> LcmChecks(const PublishConfig& publish);
/// Whether a run can have its priority and its memory.
std::vector<DoctorCheck> RealTimeChecks();

}  // namespace hitchview::app
