#pragma once

#include <atomic>
#include <csignal>

namespace hitchview::app {

inline std::atomic<bool> stop_asked{false};     ///< by SIGINT or SIGTERM
inline std::atomic<bool> trigger_asked{false};  ///< by SIGUSR1; see RecorderOptions

inline void CatchSignals() {
    const auto stop = [](int) { stop_asked = true; };
    std::signal(SIGINT, stop);
    std::signal(SIGTERM, stop);
    std::signal(SIGUSR1, [](int) { trigger_asked = true; });
}

}  // namespace hitchview::app
