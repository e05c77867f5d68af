#pragma once

#include <optional>

#include "calib/unit_adjustment.hpp"

namespace hitchview::calib {

/// Where everything roughly stands, found along the graph: surveyed targets first, then whatever
/// sees or is seen by something that has a place. A flat board has two places that look nearly
/// alike in one picture: the one that fits all other sightings better is taken. Empty: a camera
/// cannot see what it is said to see, or a camera or target hangs on nothing.
std::optional<UnitPlaces> FirstPlaces(const UnitProblem& problem, const CameraGraph& graph);

}  // namespace hitchview::calib
