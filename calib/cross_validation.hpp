#pragma once

#include <optional>

#include "calib/lens_solver.hpp"

namespace hitchview::calib {

/// Root mean squared distance in views that the solution has not seen: each is left out once, with
/// its like (see DistinctViews), in at most `folds` parts; only its place is fitted to it. Measures
/// what `rms_px` flatters. `solution`: of the whole problem. Empty: too few views to leave any out.
std::optional<double> HeldOutRms(const LensProblem& problem, const LensSolution& solution,
                                 const LensSolverOptions& options, int folds);

}  // namespace hitchview::calib
