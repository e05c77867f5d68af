#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calib/unit_problem.hpp"

namespace hitchview::calib {

/// One place of a target: of one that moves in one shot, of another in all.
struct TargetNode {
    std::size_t target = 0;
    std::string shot{};  ///< of a target that moves
};

/// Which camera sees which target, and what is tied to the unit frame.
struct CameraGraph {
    std::vector<TargetNode> nodes{};
    /// Node of each sighting; empty where it is not used, because it has too few corners.
    std::vector<std::optional<std::size_t>> node_of{};
    /// What is missing before it can be known where the cameras stand, each for a person to do
    /// something about; empty: nothing.
    std::vector<std::string> missing{};
    /// What is no obstacle, but worth knowing: sightings that are not used.
    std::vector<std::string> notes{};
    std::string text{};  ///< the graph for a person, one line for each target and camera
};

/// Looks before anything is solved. A camera can be placed when a chain of sightings leads from it
/// to a target with three surveyed corners that are not in one line, or to a camera whose pose was
/// measured. Cameras need not see the same target. A sighting counts with six corners that are not
/// in one line.
CameraGraph BuildCameraGraph(const UnitProblem& problem);

/// Whether its surveyed corners give the target's whole place.
bool PlaceIsSurveyed(const UnitTarget& target);

}  // namespace hitchview::calib
