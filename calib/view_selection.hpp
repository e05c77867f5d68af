#pragma once

#include <vector>

#include "calib/lens_solver.hpp"

namespace hitchview::calib {

/// A board looks the same when it is turned, but its bulges do not: orders the corners of every
/// view so that all name the same corner of the paper first. `solution`: of this problem, its shape
/// measured. True if a view changed.
bool TurnViewsAlike(const LensSolution& solution, LensProblem& problem);

/// Indices of the views whose errors are far above those of the others: moved, blurred, or another
/// board. At most a third of the views. `solution`: of this problem, robust.
std::vector<std::size_t> OutlierViews(const LensSolution& solution);

/// A number for each view, the same for views that are one picture: such must not be on both sides
/// of a split.
std::vector<int> DistinctViews(const LensProblem& problem);

}  // namespace hitchview::calib
