#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace hitchview::tests {

/// What hitchview-calib said.
struct CalibOutcome {
    int code = -1;
    std::string text{};  ///< stdout and stderr

    [[nodiscard]] bool Says(const std::string& what) const {
        return text.find(what) != std::string::npos;
    }
};

/// Runs hitchview-calib with arguments as for a shell.
inline CalibOutcome RunCalib(const std::string& arguments) {
    CalibOutcome outcome;
    std::FILE* const pipe = popen((HITCHVIEW_CALIB " " + arguments + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return outcome;
    std::array<char, 4096> part{};
    for (std::size_t read = 0; (read = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
        outcome.text.append(part.data(), read);
    const int status = pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

}  // namespace hitchview::tests
