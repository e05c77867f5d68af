#include <CLI/CLI.hpp>

#include "app/view_verb.hpp"

int main(int argc, char** argv) {
    constexpr int kWrongUse = 2;

    hitchview::app::ViewOptions options;
    int stale_ms = static_cast<int>(options.stale_after.count());
    CLI::App app{
        "Show the published panorama, the newest picture only; 'NO IMAGE' when none comes.\n"
        "Example: hitchview view --url 'udpm://239.255.76.67:7667?ttl=0'"};
    app.add_option("--url", options.url, "LCM network")->capture_default_str();
    app.add_option("--channel", options.channel, "LCM channel of the panorama")
        ->capture_default_str();
    app.add_option("--stale-ms", stale_ms, "older pictures are not shown, ms")
        ->check(CLI::Range(50, 10000))
        ->capture_default_str();
    app.add_option("--save", options.save,
                   "write the newest picture here (.png, .jpg) and open no window");
    app.add_option("--frames", options.frames, "end after so many pictures")
        ->check(CLI::Range(1, 1000000));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    options.stale_after = std::chrono::milliseconds(stale_ms);
    return hitchview::app::ViewVerb(options);
}
