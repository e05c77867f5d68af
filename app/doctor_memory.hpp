#pragma once

#include <cstdint>
#include <string>

#include "app/config.hpp"

namespace hitchview::app {

/// An upper estimate of what a run of the rig keeps in memory, its live cameras' buffers included.
std::uint64_t MemoryOfRun(const RigConfig& rig);

/// "256 MB": in 10^6 bytes, rounded up.
std::string Megabytes(std::uint64_t bytes);

}  // namespace hitchview::app
