#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace hitchview::test_support {

/// A TemporaryFolder that can be filled with text files.
class TempFolder {
 public:
    [[nodiscard]] std::filesystem::path path() const { return folder_.path(); }

    std::filesystem::path Write(const std::string& name, const std::string& text) const {
        std::ofstream(path() / name, std::ios::binary) << text;
        return path() / name;
    }

 private:
    tests::TemporaryFolder folder_;
};

inline std::string FileText(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

}  // namespace hitchview::test_support
