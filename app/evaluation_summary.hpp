#pragma once

#include <string>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::app {

struct Summary {
    std::string table;  ///< for a terminal, lines ended
};

/// A table of the published figures of several evaluations: a row per view and per seam
/// of each file, their means, and the published method's figures below. `files`: what `hitchview
/// eval
/// --json` wrote. What is null or missing in a file is "-" and in no mean. Refused: a file that
/// cannot be read or is not JSON.
hal::Checked<Summary> Summarise(const std::vector<std::string>& files);

}  // namespace hitchview::app
