#pragma once

#include <string>
#include <vector>

#include "algo/unit.hpp"
#include "app/evaluation.hpp"

namespace hitchview::app {

struct EvalOptions {
    algo::PerUnit<UnitVideos> units{};
    std::string panorama{};
    std::string json{};                  ///< file for the figures; empty: none
    std::string html{};                  ///< file for the report to read; empty: none
    std::vector<std::string> summary{};  ///< files of --json to tabulate; not empty: only this
    int step = 1;                        ///< see EvaluationOptions
};

/// Measures recordings, prints a table to stdout and progress to stderr. Returns the exit code: 0
/// done, 2 a video or a file is missing or cannot be used, 3 a file cannot be written.
int EvalVerb(const EvalOptions& options);

}  // namespace hitchview::app
