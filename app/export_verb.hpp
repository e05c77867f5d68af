#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace hitchview::app {

/// One of the outputs is given.
struct ExportOptions {
    std::vector<std::filesystem::path> logs{};  ///< files and folders of segments, in order
    std::filesystem::path mp4{};
    std::filesystem::path frames{};  ///< folder
    std::filesystem::path candump{};
    std::filesystem::path mcap{};
    std::filesystem::path csv{};
    std::string camera{};  ///< its pictures instead of the panorama; empty: the panorama
};

/// Writes a recording, or a part of it, in a format of other programs. Returns the exit code: 0
/// done, 1 nothing of that kind is in the recording, 2 it cannot be read, would be overwritten or
/// `stop` was set (what was written until then stays and is whole), 3 the file cannot be written or
/// ffmpeg is not there.
int ExportVerb(const ExportOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
