#include "calib/unit_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "calib/text.hpp"
#include "calib/unit_changes.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector3d;
using Reasons = std::vector<std::string>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMostYawOff_rad = 45 * kDegree;
constexpr std::size_t kFewestCorners = 20;
constexpr double kMostRms_px = 1.0;
constexpr double kMostSigmas = 5;
constexpr double kMostSurveyError_m = 0.005;
constexpr double kMostSigma_rad = 0.05 * kDegree;
constexpr double kMostSigma_m = 0.005;

double YawOff(double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi));
}

double YawOf(const UnitSolution& solution, std::size_t camera) {
    const Vector3d ahead = solution.cameras[camera].T_unit_camera.linear().col(2);
    return std::atan2(ahead.y(), ahead.x());
}

/// The camera that looks where this one should, and the other way round.
std::optional<std::size_t> SwappedWith(const UnitProblem& problem, const UnitSolution& solution,
                                       std::size_t camera) {
    for (std::size_t other = 0; other < problem.cameras.size(); ++other) {
        if (other != camera &&
            YawOff(YawOf(solution, camera), problem.cameras[other].yaw_rad) < kMostYawOff_rad &&
            YawOff(YawOf(solution, other), problem.cameras[camera].yaw_rad) < kMostYawOff_rad)
            return other;
    }
    return std::nullopt;
}

void JudgeDirections(const UnitProblem& problem, const UnitSolution& solution, Reasons& reasons) {
    std::set<std::size_t> told;
    for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
        const UnitCamera& camera = problem.cameras[i];
        if (YawOff(YawOf(solution, i), camera.yaw_rad) <= kMostYawOff_rad || told.contains(i))
            continue;
        std::string reason =
            Sentence("%s looks to %.0f degrees, but its yaw was said to be %.0f",
                     camera.name.c_str(), YawOf(solution, i) / kDegree, camera.yaw_rad / kDegree);
        if (const auto other = SwappedWith(problem, solution, i)) {
            told.insert(*other);
            reason += Sentence(": are the pictures of %s and %s swapped?", camera.name.c_str(),
                               problem.cameras[*other].name.c_str());
        }
        reasons.push_back(reason);
    }
}

void JudgeSightings(const UnitProblem& problem, const UnitSolution& solution, Reasons& reasons) {
    for (std::size_t i = 0; i < problem.sightings.size(); ++i) {
        if (!solution.sightings[i].outlier) continue;
        const Sighting& sighting = problem.sightings[i];
        reasons.push_back(Sentence(
            "%s in shot %s of %s does not fit the others (%.1f px off): look at the picture, leave "
            "it out if the target or the vehicle moved",
            problem.targets[sighting.target].name.c_str(), sighting.shot.c_str(),
            problem.cameras[sighting.camera].name.c_str(), solution.sightings[i].rms_px));
    }
}

void JudgeFit(const UnitProblem& problem, const UnitSolution& solution, Reasons& reasons) {
    for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
        const PlacedCamera& camera = solution.cameras[i];
        const char* const name = problem.cameras[i].name.c_str();
        if (camera.corners < kFewestCorners)
            reasons.push_back(Sentence(
                "%s has %zu corners that fit, at least %zu are needed: show it more targets, or "
                "nearer ones",
                name, camera.corners, kFewestCorners));
        if (!(camera.rms_px <= kMostRms_px))
            reasons.push_back(Sentence(
                "the corners of %s are %.2f px off on average, at most %.1f may be: is the lens "
                "file of this camera, and the board the right one?",
                name, camera.rms_px, kMostRms_px));
    }
}

void JudgeSurvey(const UnitProblem& problem, const CameraGraph& graph, const UnitSolution& solution,
                 Reasons& reasons) {
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
        const UnitTarget& target = problem.targets[graph.nodes[i].target];
        for (std::size_t k = 0; k < target.surveyed.size(); ++k) {
            const SurveyedCorner& corner = target.surveyed[k];
            const double off_m =
                (solution.places.T_unit_target[i] * corner.p_board_m - corner.p_unit_m).norm();
            if (off_m <= std::max(kMostSurveyError_m, kMostSigmas * target.sigma_m)) continue;
            reasons.push_back(Sentence(
                "surveyed corner %zu of %s is %.0f mm from where the pictures put it: measure it "
                "again",
                k + 1, target.name.c_str(), 1000 * off_m));
        }
    }
}

void JudgePoses(const UnitProblem& problem, const UnitSolution& solution, Reasons& reasons) {
    for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
        if (!problem.cameras[i].pose) continue;
        const MeasuredPose& pose = *problem.cameras[i].pose;
        const Eigen::Isometry3d off =
            pose.T_unit_camera.inverse() * solution.cameras[i].T_unit_camera;
        const double turn_rad = Eigen::AngleAxisd(off.linear()).angle();
        const double shift_m = off.translation().norm();
        if (turn_rad <= kMostSigmas * pose.sigma_rad && shift_m <= kMostSigmas * pose.sigma_m)
            continue;
        reasons.push_back(Sentence(
            "the measured pose of %s is %.1f degrees and %.0f mm from where the pictures put it: "
            "measure it again",
            problem.cameras[i].name.c_str(), turn_rad / kDegree, 1000 * shift_m));
    }
}

void JudgeIntervals(const UnitProblem& problem, const UnitSolution& solution, Reasons& reasons) {
    for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
        const PlacedCamera& camera = solution.cameras[i];
        const double turn_rad = camera.rpy_sigma_rad.maxCoeff();
        const double shift_m = camera.position_sigma_m.maxCoeff();
        if (turn_rad <= kMostSigma_rad && shift_m <= kMostSigma_m) continue;
        reasons.push_back(Sentence(
            "%s is known to %.3f degrees and %.1f mm only (standard deviation), %.2f degrees and "
            "%.0f mm are needed: show it more targets all over its picture, near and far, survey "
            "more corners, or more exactly",
            problem.cameras[i].name.c_str(), turn_rad / kDegree, 1000 * shift_m,
            kMostSigma_rad / kDegree, 1000 * kMostSigma_m));
    }
}

}  // namespace

std::string UnitLimits() {
    return Sentence("rms %.3g px, survey %.3g mm, known to %.3g degrees and %.3g mm", kMostRms_px,
                    1000 * kMostSurveyError_m, kMostSigma_rad / kDegree, 1000 * kMostSigma_m);
}

std::vector<std::string> JudgeUnit(const UnitProblem& problem, const CameraGraph& graph,
                                   const UnitSolution& solution) {
    Reasons reasons;
    JudgeDirections(problem, solution, reasons);
    for (const UnitChange& change : FindChanges(problem, graph, solution))
        reasons.push_back(Describe(change));
    JudgeSightings(problem, solution, reasons);
    JudgeFit(problem, solution, reasons);
    JudgeSurvey(problem, graph, solution, reasons);
    JudgePoses(problem, solution, reasons);
    JudgeIntervals(problem, solution, reasons);
    return reasons;
}

}  // namespace hitchview::calib
