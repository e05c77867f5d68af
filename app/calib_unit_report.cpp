#include "app/calib_unit_report.hpp"

#include <cstdio>
#include <numbers>

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;
/// Pixels of a panorama of 4096 for an angle.
constexpr double kPixelsPerRad = 4096 / (2 * std::numbers::pi);
constexpr double kNinetyFivePercent = 1.96;

json Numbers(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

json CameraJson(const calib::PlacedCamera& camera) {
    return {{"rpy_deg", Numbers(camera.rpy_rad / kDegree)},
            {"rpy_sigma_deg", Numbers(camera.rpy_sigma_rad / kDegree)},
            {"position_m", Numbers(camera.T_unit_camera.translation())},
            {"position_sigma_m", Numbers(camera.position_sigma_m)},
            {"rms_px", camera.rms_px},
            {"corners", camera.corners}};
}

json SightingsJson(const UnitFindings& findings) {
    json sightings = json::array();
    const calib::UnitProblem& problem = findings.session.problem;
    for (std::size_t i = 0; i < problem.sightings.size(); ++i) {
        const calib::Sighting& sighting = problem.sightings[i];
        const calib::SightingOutcome& outcome = findings.solution.sightings[i];
        sightings.push_back({{"camera", problem.cameras[sighting.camera].name},
                             {"target", problem.targets[sighting.target].name},
                             {"shot", sighting.shot},
                             {"corners", sighting.corners.size()},
                             {"used", outcome.kept},
                             {"rms_px", outcome.rms_px},
                             {"outlier", outcome.outlier}});
    }
    return sightings;
}

json FarJson(const UnitFindings& findings) {
    json pairs = json::array();
    for (std::size_t i = 0; i < findings.far.after.size(); ++i) {
        const calib::NeighbourMisalignment& pair = findings.far.after[i];
        const auto& cameras = findings.session.problem.cameras;
        pairs.push_back({{"cameras", {cameras[pair.first].name, cameras[pair.second].name}},
                         {"matches", pair.matches},
                         {"before_px", findings.far.before[i].median_rad * kPixelsPerRad},
                         {"after_px", pair.median_rad * kPixelsPerRad}});
        if (i >= findings.shown.after.size()) continue;
        pairs.back()["before_png"] = findings.shown.before[i];
        pairs.back()["after_png"] = findings.shown.after[i];
    }
    return pairs;
}

void PrintCamera(const std::string& name, const calib::PlacedCamera& camera) {
    const Eigen::Vector3d rpy = camera.rpy_rad / kDegree;
    const Eigen::Vector3d turn = kNinetyFivePercent * camera.rpy_sigma_rad / kDegree;
    const Eigen::Vector3d& p = camera.T_unit_camera.translation();
    const Eigen::Vector3d shift = kNinetyFivePercent * 1000 * camera.position_sigma_m;
    std::printf("%s\n", name.c_str());
    std::printf("  roll %.3f +- %.3f, pitch %.3f +- %.3f, yaw %.3f +- %.3f degrees\n", rpy.x(),
                turn.x(), rpy.y(), turn.y(), rpy.z(), turn.z());
    std::printf("  x %.4f m +- %.1f mm, y %.4f m +- %.1f mm, z %.4f m +- %.1f mm\n", p.x(),
                shift.x(), p.y(), shift.y(), p.z(), shift.z());
    std::printf("  errors %.3f px, %zu corners\n", camera.rms_px, camera.corners);
}

}  // namespace

json UnitJson(const UnitFindings& findings) {
    json cameras = json::object();
    for (std::size_t i = 0; i < findings.solution.cameras.size(); ++i)
        cameras[findings.session.problem.cameras[i].name] =
            CameraJson(findings.solution.cameras[i]);
    json figures{{"verb", "unit"},
                 {"unit", ToString(findings.session.unit)},
                 {"vehicle", findings.session.vehicle},
                 {"verdict", findings.reasons.empty() ? "pass" : "fail"},
                 {"reasons", findings.reasons},
                 {"notes", findings.graph.notes},
                 {"sigma_px", findings.solution.sigma_px},
                 {"survey_scale", findings.solution.prior_scale},
                 {"cameras", cameras},
                 {"sightings", SightingsJson(findings)},
                 {"far", FarJson(findings)}};
    if (!findings.shown.view.empty()) figures["view_png"] = findings.shown.view;
    return figures;
}

void PrintUnit(const UnitFindings& findings) {
    for (std::size_t i = 0; i < findings.solution.cameras.size(); ++i)
        PrintCamera(findings.session.problem.cameras[i].name, findings.solution.cameras[i]);
    for (const json& pair : FarJson(findings)) {
        std::printf(
            "%s and %s agree on what is far away to %.2f px of a panorama of 4096, %.2f "
            "with targets alone (%zu matches)\n",
            pair["cameras"][0].get<std::string>().c_str(),
            pair["cameras"][1].get<std::string>().c_str(), pair["after_px"].get<double>(),
            pair["before_px"].get<double>(), pair["matches"].get<std::size_t>());
    }
    std::printf("verdict: %s\n", findings.reasons.empty() ? "pass" : "fail");
    for (const std::string& reason : findings.reasons) std::printf("  %s\n", reason.c_str());
}

void PrintGraph(const calib::CameraGraph& graph) {
    std::printf("%s", graph.text.c_str());
    for (const std::string& note : graph.notes) std::printf("left out: %s\n", note.c_str());
}

}  // namespace hitchview::app
