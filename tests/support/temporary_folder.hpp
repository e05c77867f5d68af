#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "hal/expect.hpp"

namespace hitchview::tests {

/// A folder of its own that goes when the test ends.
class TemporaryFolder {
 public:
    TemporaryFolder() {
        std::string pattern = std::filesystem::temp_directory_path() / "hitchview-test-XXXXXX";
        HV_EXPECT(mkdtemp(pattern.data()) != nullptr);
        path_ = pattern;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    [[nodiscard]] std::string operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] std::string path() const { return path_; }

 private:
    std::filesystem::path path_;
};

}  // namespace hitchview::tests
