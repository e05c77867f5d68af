#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::app {

/// An open recording. Whoever takes `descriptor` closes it.
struct WebRecording {
    int descriptor = -1;
    std::uint64_t size_bytes = 0;  ///< now; one that is being written grows
    std::string tag{};             ///< changes with the content: an ETag, with its quotes
};

/// The recordings that may be loaded down: regular files NAME.lcm that lie directly in one folder.
class WebRecordings {
 public:
    /// An empty folder name: there are none.
    explicit WebRecordings(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// JSON: {"folder": true, "files": [{"name", "bytes", "modified_ms"}, ...]}, newest first, at
    /// most 500.
    [[nodiscard]] std::string List() const;

    /// kNotFound: not one of the list; links are not followed.
    [[nodiscard]] hal::Result<WebRecording> Open(std::string_view name) const;

 private:
    std::filesystem::path folder_;
};

}  // namespace hitchview::app
