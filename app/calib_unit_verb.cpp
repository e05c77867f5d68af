#include "app/calib_unit_verb.hpp"

#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "app/calib_provenance.hpp"
#include "app/calib_unit_pictures.hpp"
#include "app/calib_unit_report.hpp"
#include "app/calib_unit_view.hpp"
#include "app/exit_code.hpp"
#include "calib/far_matches.hpp"
#include "calib/unit_file.hpp"
#include "calib/unit_verdict.hpp"

namespace hitchview::app {
namespace {

/// What there is to work with.
struct Material {
    UnitFindings findings{};
    std::optional<calib::RigCalibration> into{};
    UnitPictures pictures{};
    std::optional<calib::UnitSolution> without_far{};  ///< from targets alone
};

/// Empty, or why there is nothing to work with.
std::string Gather(const UnitOptions& options, Material& material) {
    auto session = calib::LoadUnitSession(options.session);
    if (!session.session) return session.error;
    if (!options.far.empty()) session.session->far_shot = options.far;
    material.findings.session = std::move(*session.session);
    if (!options.into.empty()) {
        auto into = calib::LoadCalibration(options.into);
        if (!into.calibration) return into.error;
        material.into = std::move(into.calibration);
        const std::string why = calib::WhyNotInto(*material.into, material.findings.session);
        if (!why.empty()) return options.session.string() + ": " + why;
    }
    auto pictures = LookAtUnit(material.findings.session);
    if (!pictures) return pictures.error();
    material.pictures = std::move(pictures.value());
    material.findings.session.problem.sightings = material.pictures.sightings;
    return "";
}

/// Once more with what the cameras see far away. Empty, or why not.
std::string Refine(Material& material) {
    UnitFindings& findings = material.findings;
    calib::UnitProblem& problem = findings.session.problem;
    const auto shown = ReadShot(findings.session, material.pictures, findings.session.far_shot,
                                cv::IMREAD_GRAYSCALE);
    if (!shown) return shown.error();
    const calib::UnitPlaces before = findings.solution.places;
    problem.far_matches =
        calib::FindFarMatches(problem.cameras, before.T_unit_camera, shown.value());
    auto refined = calib::SolveUnitFrom(before, problem, findings.graph);
    if (!refined) return "what is far away does not fit the targets";
    findings.far.before = calib::Misalignments(problem, before.T_unit_camera);
    material.without_far = std::exchange(findings.solution, std::move(*refined));
    findings.far.after = calib::Misalignments(problem, findings.solution.places.T_unit_camera);
    return "";
}

/// The shot that most cameras have a picture of.
std::string ShotToShow(const Material& material) {
    if (!material.findings.session.far_shot.empty()) return material.findings.session.far_shot;
    std::map<std::string, int> cameras;
    for (const ShotFiles& files : material.pictures.files) {
        for (const auto& [shot, file] : files) ++cameras[shot];
    }
    return std::ranges::max_element(cameras, {}, [](const auto& shot) { return shot.second; })
        ->first;
}

/// The seam of each pair in a view, as files; their names.
std::vector<std::string> SaveSeams(const UnitOptions& options, const UnitFindings& findings,
                                   const calib::UnitSolution& solution,
                                   const std::vector<cv::Mat>& shown, const std::string& when) {
    const algo::UnitGeometry geometry = SemiSurroundOf(findings.session, solution);
    const cv::Mat3b view = DrawView(geometry, shown);
    std::vector<std::string> files;
    for (const calib::NeighbourMisalignment& pair : findings.far.after) {
        const auto& cameras = findings.session.problem.cameras;
        const std::string name = options.view.stem().string() + "_" + cameras[pair.first].name +
                                 "_" + cameras[pair.second].name + "_" + when + ".png";
        const std::filesystem::path file =
            std::filesystem::absolute(options.view).parent_path() / name;
        cv::imwrite(file.string(),
                    CropSeam(geometry, view, solution.cameras[pair.first].T_unit_camera,
                             solution.cameras[pair.second].T_unit_camera));
        files.push_back(file.string());
    }
    return files;
}

std::string SaveView(const UnitOptions& options, Material& material) {
    UnitFindings& findings = material.findings;
    const algo::UnitGeometry geometry = SemiSurroundOf(findings.session, findings.solution);
    const auto shown =
        ReadShot(findings.session, material.pictures, ShotToShow(material), cv::IMREAD_COLOR);
    if (!shown) return shown.error();
    if (!cv::imwrite(options.view.string(), DrawView(geometry, shown.value())))
        return options.view.string() + ": cannot be written";
    findings.shown.view = std::filesystem::absolute(options.view).string();
    if (!material.without_far) return "";
    findings.shown.before =
        SaveSeams(options, findings, *material.without_far, shown.value(), "before");
    findings.shown.after = SaveSeams(options, findings, findings.solution, shown.value(), "after");
    return "";
}

std::string SaveMaps(const UnitOptions& options, const UnitFindings& findings) {
    std::vector<std::string> names;
    for (const calib::UnitCamera& camera : findings.session.problem.cameras)
        names.push_back(camera.name);
    return WriteMaps(SemiSurroundOf(findings.session, findings.solution), names, options.maps);
}

std::string Save(const UnitOptions& options, Material& material) {
    const UnitFindings& findings = material.findings;
    const bool passed = findings.reasons.empty();
    std::string problem;
    if (!options.view.empty()) problem = SaveView(options, material);
    if (problem.empty() && !options.maps.empty()) problem = SaveMaps(options, findings);
    if (problem.empty() && !options.json.empty())
        problem = WriteFigures(UnitJson(findings), options.command, options.json);
    if (problem.empty() && !options.out.empty() && (passed || options.keeps_failed)) {
        const auto verdict = passed ? calib::Verdict::kPass : calib::Verdict::kFail;
        problem = calib::SaveCalibration(
            calib::WithUnit(material.into, findings.session, findings.solution, verdict,
                            WrittenBy(options.command, calib::UnitLimits())),
            options.out);
    }
    return problem;
}

int RefuseIncomplete(const calib::CameraGraph& graph) {
    for (const std::string& link : graph.missing) Fail(kWrongUse, link);
    return kWrongUse;
}

}  // namespace

CLI::App& AddUnit(CLI::App& app, UnitOptions& options) {
    CLI::App& verb =
        *app.add_subcommand("unit",
                            "Measure where the cameras of one unit stand, from pictures of targets "
                            "round it, and judge the result.\n"
                            "Exit code 0: it may be driven with, 1: not, and why.\n"
                            "Example: hitchview-calib unit --session tractor.yaml --out "
                            "rig.calib.yaml");
    verb.add_option("--session", options.session,
                    "what is in which pictures, and what was surveyed (docs/calibration-units.md)")
        ->required();
    verb.add_option("--out", options.out, "rig calibration to write");
    verb.add_option("--into", options.into, "rig calibration whose other unit is kept");
    verb.add_flag("--keep-failed", options.keeps_failed,
                  "write the calibration also when the verdict is fail");
    verb.add_option("--far", options.far,
                    "shot in which neighbours see things far away: aligns them there");
    verb.add_option("--json", options.json, "file for all figures");
    verb.add_option("--view", options.view, "picture of the unit's view, to be looked at");
    verb.add_option("--maps", options.maps,
                    "folder for where each camera is shown in the unit's view");
    return verb;
}

int UnitVerb(const UnitOptions& options) {
    Material material;
    if (const std::string why = Gather(options, material); !why.empty())
        return Fail(kWrongUse, why);
    UnitFindings& findings = material.findings;
    const calib::UnitProblem& problem = findings.session.problem;
    findings.graph = calib::BuildCameraGraph(problem);
    PrintGraph(findings.graph);
    if (!findings.graph.missing.empty()) return RefuseIncomplete(findings.graph);
    auto solution = calib::SolveUnit(problem, findings.graph);
    if (!solution)
        return Fail(kBad,
                    "no places of the cameras explain the pictures: are lenses, boards and "
                    "surveyed corners the right ones?");
    findings.solution = std::move(*solution);
    if (!findings.session.far_shot.empty()) {
        if (const std::string why = Refine(material); !why.empty()) return Fail(kWrongUse, why);
    }
    findings.reasons = calib::JudgeUnit(problem, findings.graph, findings.solution);
    PrintUnit(findings);
    if (const std::string failed = Save(options, material); !failed.empty())
        return Fail(kMachineFailed, failed);
    return findings.reasons.empty() ? 0 : kBad;
}

}  // namespace hitchview::app
