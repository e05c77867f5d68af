#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hitchview::app {

/// Programs of ours that stand beside this one. What needs a window or tracks videos again is a
/// program of its own, so that the program on the road does not load those libraries.
std::filesystem::path SiblingProgram(const std::string& name);

/// Runs a program to its end. Its exit code; 3 if it could not be started or was killed.
int RunProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments);

/// Becomes that program: signals to this process are then the program's. Returns only if it could
/// not be started: 3.
int BecomeProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments);

/// What a program wrote to its standard output, at most 64 KiB, if it ended by itself with exit
/// code 0 within `limit`; otherwise empty, and whatever of it still runs is killed. It reads
/// nothing, and what it complains of is dropped.
std::optional<std::string> OutputOf(const std::filesystem::path& program,
                                    const std::vector<std::string>& arguments,
                                    std::chrono::milliseconds limit);

/// A program that runs beside this one and is asked to end (SIGTERM) with it.
class BackgroundProgram {
 public:
    BackgroundProgram(const std::filesystem::path& program,
                      const std::vector<std::string>& arguments);
    ~BackgroundProgram();
    BackgroundProgram(const BackgroundProgram&) = delete;
    BackgroundProgram& operator=(const BackgroundProgram&) = delete;

 private:
    int process_ = -1;
};

}  // namespace hitchview::app
