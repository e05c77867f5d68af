#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>

#include "app/web_verb.hpp"

namespace {

std::atomic<bool> stop{false};

void Stop(int) {
    stop = true;
}

void AddOptions(CLI::App& app, hitchview::app::WebOptions& options) {
    app.add_option("--port", options.server.port, "TCP port; 0: one that is free, see the output")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    app.add_option("--bind", options.server.address,
                   "address to listen at; anything but loopback shows the pictures to the network")
        ->check(CLI::ValidIPV4 | CLI::IsMember({"::1", "::"}))
        ->capture_default_str();
    app.add_option("--url", options.url, "LCM network; otherwise the rig file's, or the usual one");
    app.add_option("--rig", options.rig, "rig file, for names of cameras and channels")
        ->check(CLI::ExistingFile);
    app.add_option("--recordings", options.recordings,
                   "folder whose logs (*.lcm) may be loaded down")
        ->check(CLI::ExistingDirectory);
    app.add_option("--connections", options.server.connections,
                   "most TCP connections at a time; an open page has three or four")
        ->check(CLI::Range(4, 1024))
        ->capture_default_str();
}

}  // namespace

int main(int argc, char** argv) {
    constexpr int kWrongUse = 2;
    std::signal(SIGINT, Stop);
    std::signal(SIGTERM, Stop);

    hitchview::app::WebOptions options;
    options.server.port = 8080;
    CLI::App app{
        "Show a running rig in a browser: panorama, cameras, times, hitch angle, events.\n"
        "Example: hitchview web --port 8080 --recordings /var/lib/hitchview"};
    AddOptions(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    return hitchview::app::WebVerb(options, stop);
}
