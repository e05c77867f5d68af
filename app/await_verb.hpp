#pragma once

#include <atomic>
#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace hitchview::app {

/// What is given stands in place of the rig file's.
struct AwaitOptions {
    std::filesystem::path rig{};  ///< empty: the network and channels of a rig file without keys
    std::string url{};
    std::string channel{};
    int panoramas = 1;    ///< that are to come in a row
    double within_s = 0;  ///< of the start
    bool json = false;
};

CLI::App& AddAwait(CLI::App& app, AwaitOptions& options);

/// `hitchview await`: waits until good panoramas come over LCM; see PictureJudge. Returns the exit
/// code: 0 they came, 1 they did not, 2 the rig file or an option is wrong, 3 no network.
int AwaitVerb(const AwaitOptions& options, const std::atomic<bool>& stop);

}  // namespace hitchview::app
