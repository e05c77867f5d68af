#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace hitchview::app {

/// What is given stands in place of the rig file's.
struct RecordOptions {
    std::string board{};          ///< sim, or empty: the rig's
    std::filesystem::path rig{};  ///< empty with a board
    std::filesystem::path out{};  ///< folder of the recordings, and of report.json
    std::optional<double>
        seconds{};  ///< of time for live cameras, otherwise of the drive. (0, 1200]
    std::optional<int> segment_s{};
    std::optional<int> quota_mb{};
    std::optional<int> min_free_mb{};
    std::optional<int> pre_trigger_s{};
    std::optional<int> after_trigger_s{};
    std::optional<int> memory_mb{};
    std::optional<std::string> format{};  ///< jpeg or raw
    std::optional<int> quality{};
    std::optional<int> every{};
    std::optional<int> workers{};
    std::string scenario = "slalom";  ///< of the simulated board
    int camera_width_px = 1280;       ///< of the simulated board
    int loop_frames = 0;              ///< of the simulated board; see SimulatedBoardOptions
    bool live = false;                ///< of the simulated board
    bool trap_alloc = false;
};

CLI::App& AddRecord(CLI::App& app, RecordOptions& options);

/// `hitchview record`: the whole program with a recorder beside it. `trigger`: set from outside to
/// write what was kept. Returns the exit code: 0 done, 2 rig or options are wrong, 3 a camera, the
/// network or the disk failed, also for a part of the time only.
int RecordVerb(const RecordOptions& options, const std::atomic<bool>& stop,
               std::atomic<bool>& trigger);

}  // namespace hitchview::app
