#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

namespace hitchview::app {

struct CheckOptions {
    std::vector<std::filesystem::path> logs{};  ///< files and folders of segments, in order
    bool json = false;                          ///< all figures as JSON in place of the table
    std::filesystem::path repair{};             ///< log for all whole events; empty: none
};

/// Tells how good a recording is: a table on stdout, or one JSON document and nothing else. Returns
/// the exit code: 0 good, 1 bad, 2 it cannot be read, the repaired log exists already or `stop` was
/// set, 3 a file cannot be written.
int CheckVerb(const CheckOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
