#pragma once

#include <string>

#include "algo/unit.hpp"
#include "app/evaluation.hpp"

namespace hitchview::app {

struct EvalOptions {
    algo::PerUnit<UnitVideos> units{};
    std::string panorama{};
    std::string json{};  ///< file for the figures; empty: none
    int step = 1;        ///< see EvaluationOptions
};

/// Measures recordings, prints a table to stdout and progress to stderr. Returns the exit code: 0
/// done, 2 a video is missing or cannot be used, 3 the file cannot be written.
int EvalVerb(const EvalOptions& options);

}  // namespace hitchview::app
