#include <CLI/CLI.hpp>

#include "app/eval_verb.hpp"

int main(int argc, char** argv) {
    using hitchview::algo::Unit;
    constexpr int kWrongUse = 2;

    hitchview::app::EvalOptions options;
    CLI::App app{
        "Measure stabilised views and panoramas from their pixels.\n"
        "Example: hitchview eval --tractor-in left.avi --tractor-out out/tractor.avi --json "
        "quality.json"};
    app.add_option("--tractor-in", options.units[Unit::kTractor].in, "tractor's camera recording");
    app.add_option("--tractor-out", options.units[Unit::kTractor].out,
                   "tractor's view on the canvas, before blending");
    app.add_option("--trailer-in", options.units[Unit::kTrailer].in, "trailer's camera recording");
    app.add_option("--trailer-out", options.units[Unit::kTrailer].out,
                   "trailer's view on the canvas, before blending");
    app.add_option("--panorama", options.panorama, "panorama");
    app.add_option("--json", options.json, "file for the figures");
    app.add_option("--html", options.html, "file for a report to read: charts, worst frames");
    app.add_option("--summary", options.summary,
                   "tabulate these files of --json beside the published figures, and do no more")
        ->check(CLI::ExistingFile);
    app.add_option("--step", options.step, "match every so many-th frame only")
        ->check(CLI::PositiveNumber);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : kWrongUse;
    }
    return hitchview::app::EvalVerb(options);
}
