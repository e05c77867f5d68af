#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "app/web_server.hpp"

namespace hitchview::app {

struct WebOptions {
    WebServerOptions server{};
    std::string url{};                   ///< LCM network; empty: the rig file's, else the usual one
    std::filesystem::path rig{};         ///< names of cameras and channels; empty: the usual ones
    std::filesystem::path recordings{};  ///< folder whose logs may be loaded down; empty: none
};

/// Serves the page of a running rig until `stop`. It only listens to LCM: nothing that a client
/// does reaches the program that makes the panoramas. First line of its output: the page's address.
/// Returns the exit code: 0 stopped, 2 an option is wrong, 3 no network, the port is taken.
int WebVerb(const WebOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
