#include "app/replay_verb.hpp"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/exit_code.hpp"
#include "app/log_rig.hpp"
#include "app/program.hpp"
#include "app/report.hpp"

namespace hitchview::app {
namespace {

std::vector<std::string> EvalArguments(const RigConfig& config, const std::filesystem::path& out,
                                       const std::filesystem::path& json) {
    std::vector<std::string> arguments{"--json",     json.string(),
                                       "--html",     (out / "quality.html").string(),
                                       "--panorama", (out / "panorama.avi").string()};
    for (const algo::Unit unit : algo::kUnits) {
        const auto& cameras = config.units[unit].cameras;
        if (cameras.empty()) continue;
        const std::string name = ToString(unit);
        arguments.insert(arguments.end(), {"--" + name + "-out", (out / (name + ".avi")).string()});
        // A view made of several cameras has no single recording to be compared with.
        if (cameras.size() == 1 && cameras[0].source == CameraConfig::Source::kReplay) {
            arguments.insert(arguments.end(), {"--" + name + "-in", cameras[0].replay.string()});
        }
    }
    return arguments;
}

/// Null when it could not be measured; the evaluating program has said why.
nlohmann::json MeasureQuality(const RigConfig& config, const std::filesystem::path& out) {
    const std::filesystem::path file = out / "quality.json";
    if (RunProgram(SiblingProgram("hitchview-eval"), EvalArguments(config, out, file)) != 0)
        return nullptr;
    std::ifstream in(file);
    nlohmann::json quality = nlohmann::json::parse(in, nullptr, false);
    if (!quality.is_object()) return nullptr;
    // The run's report holds figures only; the rest stays in its own file.
    quality.erase("series");
    quality.erase("recordings");
    return quality;
}

/// Two passes over a recording may take minutes before anything else is seen.
void ShowProgress(const char* step, std::uint64_t frames) {
    constexpr std::uint64_t kEvery = 10;
    if (frames % kEvery != 0) return;
    std::fprintf(stderr, "\r%s %llu frame sets", step, static_cast<unsigned long long>(frames));
}

/// Why the options contradict each other; empty if they do not.
std::string Contradiction(const ReplayOptions& options) {
    if (options.run.offline && options.run.realtime)
        return "--offline reads all of a recording before it shows a frame: not with --realtime";
    if (options.run.offline && options.run.lookahead_frames)
        return "--offline sees all frames ahead: not with --lookahead";
    if (options.run.speed != 1 && !options.run.realtime)
        return "--speed needs --realtime: otherwise it goes as fast as it can";
    if (options.coupling && !options.run.offline) return "--coupling needs --offline";
    if (options.run.offline && !options.faults.empty())
        return "--offline sees every frame twice: not with --faults";
    if (options.rig.empty() && options.logs.empty()) return "--rig or --log is needed";
    const bool part = !options.from.empty() || !options.to.empty();
    if (part && options.logs.empty()) return "--from and --to need --log";
    return "";
}

}  // namespace

int ReplayVerb(const ReplayOptions& options, const std::atomic<bool>& stop) {
    if (const std::string why = Contradiction(options); !why.empty()) return Fail(kWrongUse, why);
    const auto config = options.logs.empty() ? LoadRigConfig(options.rig)
                                             : LoadLogRig({.logs = options.logs,
                                                           .rig = options.rig,
                                                           .from = options.from,
                                                           .to = options.to},
                                                          stop);
    if (!config) return Fail(kWrongUse, config.error());
    RunOptions run = options.run;
    if (!options.faults.empty()) {
        auto script = LoadFaultScript(options.faults);
        if (!script) return Fail(kWrongUse, script.error());
        if (const auto checked = CheckCameras(*script, config.value()); !checked)
            return Fail(kWrongUse, checked.error());
        run.faults = std::move(*script);
    }
    if (options.coupling == "literal") run.coupling = algo::Coupling::kLiteral;
    run.write_video = run.write_video || options.metrics;
    run.write_views = run.write_views || options.metrics;
    if (run.out.empty() && (run.write_video || run.write_views)) {
        return Fail(kWrongUse, "--out is needed to write videos or to measure them");
    }

    if (run.offline) run.progress = ShowProgress;
    const auto summary = RunRig(config.value(), run, stop);
    if (run.offline) std::fputc('\n', stderr);
    if (!summary) return Fail(kMachineFailed, summary.error());
    std::fputs(Table(summary.value()).c_str(), stdout);
    if (run.out.empty()) return 0;

    const nlohmann::json quality =
        options.metrics ? MeasureQuality(config.value(), run.out) : nlohmann::json();
    const std::string refused =
        WriteJson(MakeReport(summary.value(), quality), run.out / "report.json");
    return refused.empty() ? 0 : Fail(kMachineFailed, refused);
}

}  // namespace hitchview::app
