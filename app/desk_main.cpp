#include <CLI/CLI.hpp>

#include "app/desk_arguments.hpp"
#include "app/exit_code.hpp"
#include "app/log_arguments.hpp"
#include "app/record_verb.hpp"
#include "app/run_arguments.hpp"
#include "app/signals.hpp"

// The verbs of `hitchview` that read or write videos and pictures.
int main(int argc, char** argv) {
    using namespace hitchview::app;
    CatchSignals();

    CLI::App app{"Hitchview at the desk: recordings and simulated drives"};
    app.set_version_flag("--version", HITCHVIEW_VERSION);
    app.require_subcommand(1);

    DemoOptions demo;
    const CLI::App& demo_verb = AddDemo(app, demo);
    ReplayOptions replay;
    const CLI::App& replay_verb = AddReplay(app, replay);
    ExportOptions exporting;
    const CLI::App& export_verb = AddExport(app, exporting);
    ScenariosOptions scenarios;
    const CLI::App& scenarios_verb = AddScenarios(app, scenarios);
    BenchOptions bench;
    const CLI::App& bench_verb = AddBench(app, bench);
    ReplayOptions run;
    AddRun(app, run, trigger_asked);
    RecordOptions record;
    const CLI::App& record_verb = AddRecord(app, record);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kGood : kWrongUse;
    }
    if (demo_verb.parsed()) return DemoVerb(demo, stop_asked);
    if (replay_verb.parsed()) return ReplayVerb(replay, stop_asked);
    if (export_verb.parsed()) return ExportVerb(exporting, stop_asked);
    if (scenarios_verb.parsed()) return ScenariosVerb(scenarios, stop_asked);
    if (bench_verb.parsed()) return BenchVerb(bench, stop_asked);
    if (record_verb.parsed()) return RecordVerb(record, stop_asked, trigger_asked);
    return ReplayVerb(run, stop_asked);
}
