#pragma once

#include <cstdint>
#include <optional>

namespace hitchview::app {

/// What this process has of the machine's memory. Reading takes no memory.
struct Resources {
    std::optional<std::uint64_t> rss_bytes{};  ///< resident; empty where /proc does not tell
    std::uint64_t minor_faults = 0;            ///< pages mapped without reading a disk, since start
    std::uint64_t major_faults = 0;            ///< pages read from a disk, since start
};

Resources ReadResources();

}  // namespace hitchview::app
