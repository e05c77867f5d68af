#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calib/far_matches.hpp"
#include "calib/unit_session.hpp"
#include "calib/unit_solver.hpp"

namespace hitchview::app {

/// How well neighbours agree on what is far away, with the targets alone and with what was seen far
/// away; empty: nothing was looked at.
struct FarAlignment {
    std::vector<calib::NeighbourMisalignment> before{};
    std::vector<calib::NeighbourMisalignment> after{};
};

/// Pictures of the unit's view that were written, to be looked at.
struct UnitPictureFiles {
    std::string view{};                 ///< empty: none
    std::vector<std::string> before{};  ///< of each pair of FarAlignment: its seam, targets alone
    std::vector<std::string> after{};
};

/// Everything that was found out about a unit.
struct UnitFindings {
    calib::UnitSession session{};
    calib::CameraGraph graph{};
    calib::UnitSolution solution{};
    FarAlignment far{};
    UnitPictureFiles shown{};
    std::vector<std::string> reasons{};  ///< empty: it may be driven with
};

/// All figures (docs/calibration-units.md).
nlohmann::json UnitJson(const UnitFindings& findings);

/// The same for a person, on stdout.
void PrintUnit(const UnitFindings& findings);

/// What hangs together, and what is left out, on stdout.
void PrintGraph(const calib::CameraGraph& graph);

}  // namespace hitchview::app
