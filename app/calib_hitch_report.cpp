#include "app/calib_hitch_report.hpp"

#include <cstdio>
#include <numbers>

#include "calib/yaml_map.hpp"

namespace hitchview::app {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNinetyFivePercent = 1.96;

json Numbers(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

void PrintPoint(const char* unit, const Vector3d& at_m, const Vector3d& sigma_m) {
    const Vector3d within_mm = 1000 * kNinetyFivePercent * sigma_m;
    std::printf(
        "hitch point in the %s's frame: x %.4f m +- %.1f mm, y %.4f m +- %.1f mm, z %.3f m\n", unit,
        at_m.x(), within_mm.x(), at_m.y(), within_mm.y(), at_m.z());
}

void PrintVerdict(const Reasons& reasons) {
    std::printf("verdict: %s\n", reasons.empty() ? "pass" : "fail");
    for (const std::string& reason : reasons) std::printf("  %s\n", reason.c_str());
}

/// What the rig file's signal would have to be for the sensor to agree with the images.
struct Signal {
    double factor_deg;
    double offset_deg;
};
std::optional<Signal> Corrected(const calib::AngleFit& fit, const HitchLog& log) {
    if (!log.factor_deg) return std::nullopt;
    return Signal{fit.factor * *log.factor_deg,
                  fit.factor * log.offset_deg + fit.offset_rad / kDegree};
}

}  // namespace

json HitchJson(const calib::HitchSolution& solution, const Reasons& reasons) {
    json shots = json::array();
    for (const calib::ShotArticulation& shot : solution.shots) {
        shots.push_back({{"shot", shot.shot},
                         {"yaw_deg", shot.yaw_rad / kDegree},
                         {"sigma_deg", shot.sigma_rad / kDegree},
                         {"pitch_deg", shot.pitch_rad / kDegree},
                         {"roll_deg", shot.roll_rad / kDegree}});
    }
    const auto& straight = solution.straight_sigma_rad;
    return {{"verb", "hitch"},
            {"verdict", reasons.empty() ? "pass" : "fail"},
            {"reasons", reasons},
            {"hitch_tractor_m", Numbers(solution.hitch_tractor_m)},
            {"hitch_tractor_sigma_m", Numbers(solution.sigma_tractor_m)},
            {"hitch_trailer_m", Numbers(solution.hitch_trailer_m)},
            {"hitch_trailer_sigma_m", Numbers(solution.sigma_trailer_m)},
            {"height_is_measured", solution.height_is_measured},
            {"straight_deg", solution.straight_rad / kDegree},
            {"straight_sigma_deg", straight ? json(*straight / kDegree) : json(nullptr)},
            {"rms_px", solution.rms_px},
            {"sigma_px", solution.sigma_px},
            {"shots", shots},
            {"loose_shots", solution.loose_shots}};
}

void PrintHitch(const calib::HitchSolution& solution, const Reasons& reasons) {
    PrintPoint("tractor", solution.hitch_tractor_m, solution.sigma_tractor_m);
    PrintPoint("trailer", solution.hitch_trailer_m, solution.sigma_trailer_m);
    std::printf("its height is %s\n",
                solution.height_is_measured
                    ? "as the pictures tell it"
                    : "as it was given: a trailer that only yaws does not tell it (--height)");
    if (solution.straight_sigma_rad)
        std::printf("in line at a yaw of %.3f +- %.3f degrees between the frames as they were\n",
                    solution.straight_rad / kDegree,
                    kNinetyFivePercent * *solution.straight_sigma_rad / kDegree);
    for (const calib::ShotArticulation& shot : solution.shots)
        std::printf("  shot %s: articulation %.2f +- %.2f degrees, pitch %.2f, roll %.2f\n",
                    shot.shot.c_str(), shot.yaw_rad / kDegree,
                    kNinetyFivePercent * shot.sigma_rad / kDegree, shot.pitch_rad / kDegree,
                    shot.roll_rad / kDegree);
    for (const std::string& shot : solution.loose_shots)
        std::printf("left out: shot %s, in which no targets link both units to the other shots\n",
                    shot.c_str());
    std::printf("errors  %.3f px\n", solution.rms_px);
    PrintVerdict(reasons);
}

json AngleJson(const calib::AngleFit& fit, const HitchLog& log, const Reasons& reasons) {
    const auto signal = Corrected(fit, log);
    return {{"verb", "hitch"},
            {"verdict", reasons.empty() ? "pass" : "fail"},
            {"reasons", reasons},
            {"factor", fit.factor},
            {"factor_sigma", fit.factor_sigma},
            {"offset_deg", fit.offset_rad / kDegree},
            {"offset_sigma_deg", fit.offset_sigma_rad / kDegree},
            {"spread_deg", fit.spread_rad / kDegree},
            {"straight_s", fit.straight_s},
            {"scatter_deg", fit.scatter_rad / kDegree},
            {"seconds", fit.seconds},
            {"signal_factor_deg", signal ? json(signal->factor_deg) : json(nullptr)},
            {"signal_offset_deg", signal ? json(signal->offset_deg) : json(nullptr)}};
}

void PrintAngles(const calib::AngleFit& fit, const HitchLog& log, const Reasons& reasons) {
    std::printf("articulation = (%.4f +- %.4f) * hitch angle + (%.3f +- %.3f) degrees\n",
                fit.factor, kNinetyFivePercent * fit.factor_sigma, fit.offset_rad / kDegree,
                kNinetyFivePercent * fit.offset_sigma_rad / kDegree);
    std::printf(
        "%zu s compared, %.0f s of them straight, over %.1f degrees; scatter %.2f degrees\n",
        fit.seconds, fit.straight_s, fit.spread_rad / kDegree, fit.scatter_rad / kDegree);
    if (const auto signal = Corrected(fit, log)) {
        std::printf(
            "for can.hitch_angle in the rig file:\n    factor_deg: %s\n    offset_deg: %s\n",
            calib::ExactText(signal->factor_deg).c_str(),
            calib::ExactText(signal->offset_deg).c_str());
    } else {
        std::printf(
            "the signal comes from a DBC file: give its bits in the rig file instead, with "
            "the factor times %.4f and the offset times that plus %.3f degrees\n",
            fit.factor, fit.offset_rad / kDegree);
    }
    PrintVerdict(reasons);
}

}  // namespace hitchview::app
