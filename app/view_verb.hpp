#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace hitchview::app {

struct ViewOptions {
    std::string url = "udpm://239.255.76.67:7667?ttl=0";
    std::string channel = "PANORAMA";
    std::string health_channel = "PANORAMA_HEALTH";  ///< tells what the cameras are called
    /// Pictures that were captured longer ago are not shown. [50, 10000]
    std::chrono::milliseconds max_age{500};
    /// Write what is shown in the end to this file (.png, .jpg) instead of opening a window.
    std::string save = {};
    /// End after so many pictures. [1, 1000000]; with `save`: 1 unless given.
    std::optional<int> frames = {};
    /// Longest time without a picture, when `save` or `frames` is given. [100, 600000]
    std::chrono::milliseconds wait{10'000};
};

/// The display unit's program: shows the newest panorama until the window is closed or Esc or 'q'
/// is pressed. Returns the exit code: 0 done, 1 the pictures did not come in time, 2 an option is
/// wrong, 3 no network, no display or the file cannot be written.
int ViewVerb(const ViewOptions& options);

}  // namespace hitchview::app
