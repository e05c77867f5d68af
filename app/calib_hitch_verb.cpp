#include "app/calib_hitch_verb.hpp"

#include <cstdio>

#include "app/calib_hitch_report.hpp"
#include "app/calib_provenance.hpp"
#include "app/calib_unit_pictures.hpp"
#include "app/exit_code.hpp"
#include "calib/hitch_session.hpp"

namespace hitchview::app {
namespace {

/// The cameras and targets as the pictures of a unit are looked at.
calib::UnitSession Looked(const calib::HitchSession& session) {
    calib::UnitSession looked;
    for (std::size_t i = 0; i < session.problem.cameras.size(); ++i)
        looked.problem.cameras.push_back(
            {.name = session.problem.names[i], .model = session.problem.cameras[i].model});
    looked.problem.targets = session.problem.targets;
    looked.pictures = session.pictures;
    return looked;
}

std::string Save(const HitchOptions& options, const calib::HitchSession& session,
                 const calib::HitchSolution& solution, const Reasons& reasons) {
    std::string problem;
    if (!options.json.empty())
        problem = WriteFigures(HitchJson(solution, reasons), options.command, options.json);
    const bool writes = !options.out.empty() && (reasons.empty() || options.keeps_failed);
    if (!problem.empty() || !writes) return problem;
    calib::RigCalibration rig = calib::WithHitch(session.rig, solution);
    if (!reasons.empty()) rig.verdict = calib::Verdict::kFail;
    rig.written_by = WrittenBy(options.command, calib::HitchLimits());
    return calib::SaveCalibration(rig, options.out);
}

int FromPictures(const HitchOptions& options) {
    auto loaded = calib::LoadHitchSession(options.session);
    if (!loaded.session) return Fail(kWrongUse, loaded.error);
    calib::HitchProblem& problem = loaded.session->problem;
    problem.straight.insert(problem.straight.end(), options.straight.begin(),
                            options.straight.end());
    problem.height_m = options.height_m.value_or(problem.height_m);
    auto pictures = LookAtUnit(Looked(*loaded.session));
    if (!pictures) return Fail(kWrongUse, pictures.error());
    problem.sightings = std::move(pictures->sightings);
    const auto solution = calib::SolveHitch(problem);
    if (!solution)
        return Fail(kBad,
                    "no hitch point explains the pictures: at least two shots must show targets to "
                    "both units, and some of these targets to both or in several shots");
    const Reasons reasons = calib::JudgeHitch(problem, *solution);
    PrintHitch(*solution, reasons);
    const std::string failed = Save(options, *loaded.session, *solution, reasons);
    if (!failed.empty()) return Fail(kMachineFailed, failed);
    return reasons.empty() ? 0 : kBad;
}

int FromLog(const HitchOptions& options) {
    const auto log = ReadHitchLog(options.log);
    if (!log) return Fail(kWrongUse, log.error());
    const auto fit = calib::FitAngles(log.value().pairs);
    if (!fit)
        return Fail(kBad,
                    "the drive is too short or has no turn: no factor and no offset can be "
                    "told");
    const Reasons reasons = calib::JudgeAngles(*fit);
    PrintAngles(*fit, log.value(), reasons);
    const std::string failed =
        options.json.empty()
            ? ""
            : WriteFigures(AngleJson(*fit, log.value(), reasons), options.command, options.json);
    if (!failed.empty()) return Fail(kMachineFailed, failed);
    return reasons.empty() ? 0 : kBad;
}

}  // namespace

CLI::App& AddHitch(CLI::App& app, HitchOptions& options) {
    CLI::App& verb =
        *app.add_subcommand("hitch",
                            "Find the point that the units turn about, from pictures of both "
                            "units' cameras; or factor and offset of the vehicle's hitch angle, "
                            "from a log.\n"
                            "Exit code 0: it may be driven with, 1: not, and why.\n"
                            "Example: hitchview-calib hitch --session hitch.yaml --straight 001 "
                            "--out rig.calib.yaml");
    auto* const source = verb.add_option_group("source");
    source->add_option("--session", options.session,
                       "what is in which pictures (docs/calibration-units.md)");
    source->add_option("--log", options.log,
                       "recording with panoramas and hitch angles: files or folders");
    source->require_option(1);
    verb.add_option("--out", options.out,
                    "rig calibration to write, with the hitch point as the origin");
    verb.add_option("--straight", options.straight, "shots with the units in line");
    verb.add_option("--height", options.height_m,
                    "height of the hitch point in the tractor's frame as it is, m");
    verb.add_flag("--keep-failed", options.keeps_failed,
                  "write the calibration also when the verdict is fail");
    verb.add_option("--json", options.json, "file for all figures");
    return verb;
}

int HitchVerb(const HitchOptions& options) {
    return options.log.empty() ? FromPictures(options) : FromLog(options);
}

}  // namespace hitchview::app
