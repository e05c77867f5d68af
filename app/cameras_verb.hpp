#pragma once

#include <filesystem>

namespace hitchview::app {

struct CamerasOptions {
    std::filesystem::path rig;   ///< whose cameras are looked for; empty: none
    std::filesystem::path json;  ///< file for everything that is known; empty: none
    bool all = false;            ///< every format, size and rate that is offered
    bool measure = false;        ///< stream from each free device to measure its memory
};

/// Tells what video devices this machine has, what would be picked of each and why, and whether a
/// rig's are there. Returns the exit code: 0 there is one that can be opened, with a rig
/// all of its V4L2 cameras can be used; 1 otherwise; 2 the rig file is bad or has none of these; 3
/// the file cannot be written.
int CamerasVerb(const CamerasOptions& options);

}  // namespace hitchview::app
