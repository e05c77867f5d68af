#include <CLI/CLI.hpp>

#include "app/await_verb.hpp"

namespace hitchview::app {

CLI::App& AddAwait(CLI::App& app, AwaitOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "await",
        "Wait until good panoramas come over LCM, one after the other: sound, numbered on, "
        "captured\n"
        "less than 1 s ago, with a picture of at least one camera. Exit code 1 if too few came.\n"
        "Example: hitchview await --rig /etc/hitchview/rig.yaml --panoramas 30 --within 60");
    verb.add_option("--rig", options.rig, "rig file that names network, channel and cameras")
        ->check(CLI::ExistingFile);
    verb.add_option("--url", options.url, "LCM network, instead of the rig file's");
    verb.add_option("--channel", options.channel,
                    "LCM channel of the panorama, instead of the rig file's");
    verb.add_option("--panoramas", options.panoramas, "how many are to come in a row")
        ->check(CLI::Range(1, 1'000'000))
        ->required();
    verb.add_option("--within", options.within_s, "of the start, seconds")
        ->check(CLI::Range(0.1, 3600.0))
        ->required();
    verb.add_flag("--json", options.json, "print JSON instead of a sentence");
    return verb;
}

}  // namespace hitchview::app
