#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <filesystem>
#include <string>

namespace hitchview::app {

struct CaptureOptions {
    std::string board{};                      ///< as ReadBoard takes it
    std::string rig{};                        ///< rig file; or one of the next
    std::string video{};                      ///< a film
    std::string images{};                     ///< pattern of the shell
    std::string log{};                        ///< a recording; `camera` is one of its
    std::string camera{};                     ///< its name; of a rig: this one only
    int views = 20;                           ///< of each camera, at least
    std::filesystem::path out{};              ///< folder: one folder for each camera in it
    std::filesystem::path json{};             ///< all figures; empty: none
    std::string command{};                    ///< for the figures
    const std::atomic<bool>* stop = nullptr;  ///< set from outside: the source ends; null: never
};

CLI::App& AddCapture(CLI::App& app, CaptureOptions& options);

/// Chooses pictures of a board from which lenses can be measured, and tells on the terminal what to
/// do next. Ends when every camera has enough. 0: it has; 1: the source ended before, what is
/// missing is told; 2: wrong use; 3: a file could not be written.
int CaptureVerb(const CaptureOptions& options);

}  // namespace hitchview::app
