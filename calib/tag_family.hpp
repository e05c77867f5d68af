#pragma once

#include <array>

namespace hitchview::calib {

/// Modules along a tag's side, with the black frame and without the white one around it.
inline constexpr int kTagModules = 8;

/// How many tags tag36h11 has: their numbers are [0, kTags).
inline constexpr int kTags = 587;

/// Which modules of a tag are dark, row by row from its top left.
using TagModules = std::array<bool, kTagModules * kTagModules>;

/// Tag `number` of tag36h11. Thread-safe.
TagModules DarkModules(int number);

}  // namespace hitchview::calib
