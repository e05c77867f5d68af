#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace hitchview::tests {

/// Path of a recording under HITCHVIEW_TEST_DATA (or ../shared/data beside the source tree); empty
/// when it is not there: the test then skips.
inline std::string TestData(const std::string& name) {
    const char* const folder = std::getenv("HITCHVIEW_TEST_DATA");
    const std::filesystem::path path =
        std::filesystem::path(folder != nullptr ? folder : HITCHVIEW_SOURCE_DIR "/../shared/data") /
        name;
    return std::filesystem::exists(path) ? path.string() : std::string();
}

}  // namespace hitchview::tests
