#include <CLI/CLI.hpp>

#include "app/view_verb.hpp"

int main(int argc, char** argv) {
    constexpr int kWrongUse = 2;

    hitchview::app::ViewOptions options;
    int max_age_ms = static_cast<int>(options.max_age.count());
    CLI::App app{
        "Show the published panorama, the newest picture only; 'NO IMAGE' and why when none\n"
        "comes or it is too old; names the cameras that give no picture.\n"
        "Example: hitchview view --url 'udpm://239.255.76.67:7667?ttl=0'"};
    app.add_option("--url", options.url, "LCM network")->capture_default_str();
    app.add_option("--channel", options.channel, "LCM channel of the panorama")
        ->capture_default_str();
    app.add_option("--health-channel", options.health_channel,
                   "LCM channel that tells what the cameras are called")
        ->capture_default_str();
    app.add_option("--max-age-ms", max_age_ms, "pictures captured longer ago are not shown, ms")
        ->check(CLI::Range(50, 10000))
        ->capture_default_str();
    app.add_option("--save", options.save,
                   "write what is shown in the end here (.png, .jpg) and open no window");
    app.add_option("--frames", options.frames, "end after so many pictures")
        ->check(CLI::Range(1, 1000000));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    options.max_age = std::chrono::milliseconds(max_age_ms);
    return hitchview::app::ViewVerb(options);
}
