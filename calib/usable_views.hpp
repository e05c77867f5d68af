#pragma once

#include <vector>

#include "calib/intrinsics.hpp"

namespace hitchview::calib {

/// Which pictures are worth solving with, before anything is solved: a board of which too little is
/// seen, or that is smeared compared with the others, is not.
std::vector<ViewOutcome> LookAtViews(const LensPictures& pictures);

/// The problem of the views that `outcomes` lets be used. `used`: their indices.
LensProblem ProblemOf(const LensPictures& pictures, const std::vector<ViewOutcome>& outcomes,
                      std::vector<std::size_t>& used);

}  // namespace hitchview::calib
