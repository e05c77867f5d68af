#include "app/calib_verify_verb.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "app/calib_pictures.hpp"
#include "app/calib_provenance.hpp"
#include "app/calib_unit_pictures.hpp"
#include "app/calib_unit_view.hpp"
#include "app/calib_verify_log.hpp"
#include "app/calib_verify_report.hpp"
#include "app/config.hpp"
#include "app/exit_code.hpp"
#include "calib/far_matches.hpp"
#include "calib/rig_calibration.hpp"
#include "calib/verification.hpp"

namespace hitchview::app {
namespace {

/// The panorama that neighbours are compared in.
struct Panorama {
    algo::Projection canvas;
    algo::AlignmentSurface surface;
};

Panorama PanoramaOf(const CanvasConfig& canvas) {
    return {algo::Projection::Cylinder(canvas.size_px.width_px, canvas.size_px.height_px,
                                       canvas.horizon),
            {.radius_m = canvas.radius_m,
             .viewpoint_m = canvas.viewpoint_m,
             .ground_m = canvas.ground_m}};
}

hal::Checked<Panorama> PanoramaOf(const std::filesystem::path& rig) {
    if (rig.empty()) return PanoramaOf(CanvasConfig{.size_px = {4096, 720}});
    const auto config = LoadRigConfig(rig);
    if (!config) return config.error();
    const CanvasConfig& canvas = config.value().canvas;
    if (canvas.projection != CanvasConfig::Projection::kCylinder)
        return rig.string() +
               ": canvas.projection is plane, must be cylinder: a plane has no "
               "calibration to verify";
    return PanoramaOf(canvas);
}

hal::Checked<std::vector<calib::UnitTarget>> TargetsOf(const std::vector<std::string>& boards) {
    std::vector<calib::UnitTarget> targets;
    for (const std::string& text : boards) {
        const calib::ParsedBoard board = calib::ReadBoard(text);
        if (!board.board) return board.error;
        targets.push_back({.name = text, .board = *board.board, .moves = true});
    }
    return targets;
}

/// A unit as its calibration has it.
calib::UnitSession SessionOf(const calib::RigCalibration& calibration, algo::Unit unit,
                             const std::filesystem::path& folder,
                             const std::vector<calib::UnitTarget>& targets) {
    calib::UnitSession session{.unit = unit, .vehicle = calibration.vehicle};
    session.problem.targets = targets;
    for (const auto& [name, camera] : calibration.cameras) {
        if (camera.unit != unit) continue;
        const algo::CameraGeometry geometry = camera.Geometry();
        const Eigen::Vector3d axis = geometry.T_unit_camera.linear().col(2);
        session.problem.cameras.push_back(
            {.name = name,
             .model = geometry.model,
             .yaw_rad = std::atan2(axis.y(), axis.x()),
             .pose = calib::MeasuredPose{.T_unit_camera = geometry.T_unit_camera}});
        session.pictures.push_back((folder / name / "*").string());
    }
    return session;
}

/// Shots of which every camera has a picture.
std::vector<std::string> WholeShots(const UnitPictures& pictures) {
    std::vector<std::string> shots;
    for (const auto& [shot, file] : pictures.files[0]) {
        if (std::ranges::all_of(pictures.files,
                                [&](const ShotFiles& files) { return files.contains(shot); }))
            shots.push_back(shot);
    }
    return shots;
}

std::vector<Eigen::Isometry3d> PlacesOf(const calib::UnitProblem& problem) {
    std::vector<Eigen::Isometry3d> places;
    for (const calib::UnitCamera& camera : problem.cameras)
        places.push_back(camera.pose->T_unit_camera);
    return places;
}

/// Adds what neighbours see far away in some of the shots. Empty, or why not.
std::string AddFarMatches(const UnitPictures& pictures, calib::UnitSession& session) {
    constexpr std::size_t kMostShots = 5;
    if (session.problem.cameras.size() < 2) return "";
    std::vector<std::string> shots = WholeShots(pictures);
    shots.resize(std::min(shots.size(), kMostShots));
    const std::vector<Eigen::Isometry3d> places = PlacesOf(session.problem);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const auto shown = ReadShot(session, pictures, shots[i], cv::IMREAD_GRAYSCALE);
        if (!shown) return shown.error();
        const auto matches = calib::FindFarMatches(session.problem.cameras, places, shown.value());
        session.problem.far_matches.insert(session.problem.far_matches.end(), matches.begin(),
                                           matches.end());
        ShowProgress("compared", i + 1, shots.size(), "shots");
    }
    return "";
}

std::string Draw(const calib::UnitSession& session, const UnitPictures& pictures,
                 const std::filesystem::path& folder, VerifyFindings& findings) {
    const std::vector<std::string> shots = WholeShots(pictures);
    if (folder.empty() || shots.empty()) return "";
    std::error_code refused;
    std::filesystem::create_directories(folder, refused);
    const auto shown = ReadShot(session, pictures, shots[0], cv::IMREAD_COLOR);
    if (!shown) return shown.error();
    calib::UnitSolution solution;
    for (const Eigen::Isometry3d& place : PlacesOf(session.problem))
        solution.cameras.push_back({.T_unit_camera = place});
    const std::string name = std::string(ToString(session.unit)) + ".png";
    const cv::Mat3b view = DrawView(SemiSurroundOf(session, solution), shown.value());
    if (!cv::imwrite((folder / name).string(), view))
        return (folder / name).string() + ": cannot be written";
    findings.pictures.emplace_back(
        std::string("semi-surround view of the ") + ToString(session.unit) + ", as calibrated",
        std::filesystem::absolute(folder / name).string());
    return "";
}

/// A failure with the exit code that it has.
struct Failure {
    int code = 0;
    std::string why{};
};

Failure CheckUnit(const calib::RigCalibration& calibration, algo::Unit unit,
                  const VerifyOptions& options, const std::vector<calib::UnitTarget>& targets,
                  const Panorama& panorama, VerifyFindings& findings) {
    calib::UnitSession session = SessionOf(calibration, unit, options.pictures, targets);
    if (session.problem.cameras.empty()) return {};
    const auto pictures = LookAtUnit(session);
    if (!pictures) return {kWrongUse, pictures.error()};
    session.problem.sightings = pictures.value().sightings;
    if (const std::string why = AddFarMatches(pictures.value(), session); !why.empty())
        return {kWrongUse, why};
    const auto checks = calib::CheckUnit(session.problem, panorama.canvas.focal_px);
    findings.checks.insert(findings.checks.end(), checks.begin(), checks.end());
    const std::string why = Draw(session, pictures.value(), options.view, findings);
    return why.empty() ? Failure{} : Failure{kMachineFailed, why};
}

std::vector<std::string> NamesOf(const calib::RigCalibration& calibration) {
    std::vector<std::string> names;
    for (const auto& [name, camera] : calibration.cameras) names.push_back(name);
    return names;
}

int Verify(const calib::RigCalibration& calibration, const VerifyOptions& options) {
    const auto panorama = PanoramaOf(options.rig);
    if (!panorama) return Fail(kWrongUse, panorama.error());
    const auto targets = TargetsOf(options.boards);
    if (!targets) return Fail(kWrongUse, targets.error());
    VerifyFindings findings;
    for (const algo::Unit unit : algo::kUnits) {
        const Failure failure =
            CheckUnit(calibration, unit, options, targets.value(), panorama.value(), findings);
        if (failure.code != 0) return Fail(failure.code, failure.why);
    }
    const auto holes = calib::CheckHoles(
        calib::FindHoles(calibration, panorama.value().canvas, panorama.value().surface));
    findings.checks.insert(findings.checks.end(), holes.begin(), holes.end());
    PrintVerify(findings);
    if (!options.json.empty()) {
        const std::string why =
            WriteFigures(VerifyJson(findings, calibration, options.calibration.string()),
                         options.command, options.json);
        if (!why.empty()) return Fail(kMachineFailed, why);
    }
    return findings.AreGood() ? 0 : kBad;
}

}  // namespace

CLI::App& AddVerify(CLI::App& app, VerifyOptions& options) {
    CLI::App& verb = *app.add_subcommand(
        "verify",
        "Compare a calibration with fresh pictures: lenses, neighbours, cameras that moved, "
        "holes.\n"
        "Exit code 0: it still holds, 1: not, and why.\n"
        "Example: hitchview-calib verify --calibration rig.calib.yaml --pictures today/");
    verb.add_option("--calibration", options.calibration, "rig calibration")->required();
    auto* const source = verb.add_option_group("fresh pictures");
    source->add_option("--pictures", options.pictures,
                       "a folder of pictures for each camera, named as the camera is; pictures of "
                       "one moment have the same name");
    source->add_option("--log", options.logs, "a recorded drive: log files, or folders of them");
    source->require_option(1);
    verb.add_option("--board", options.boards, "a board that is in them, as in intrinsics");
    verb.add_option("--rig", options.rig,
                    "rig file whose panorama it is; otherwise one of 4096 x 720");
    verb.add_option("--json", options.json, "file for all figures");
    verb.add_option("--view", options.view, "folder for pictures to be looked at");
    return verb;
}

int VerifyVerb(const VerifyOptions& options) {
    const calib::LoadedCalibration loaded = calib::LoadCalibration(options.calibration);
    if (!loaded.calibration) return Fail(kWrongUse, loaded.error);
    if (options.logs.empty()) return Verify(*loaded.calibration, options);
    const auto drive = DrivePictures::Take(options.logs, NamesOf(*loaded.calibration));
    if (!drive) return Fail(kWrongUse, drive.error());
    VerifyOptions with_pictures = options;
    with_pictures.pictures = drive.value().path();
    return Verify(*loaded.calibration, with_pictures);
}

}  // namespace hitchview::app
