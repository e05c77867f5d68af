#include <algorithm>
#include <numbers>

#include "calib/hitch_solver.hpp"
#include "calib/text.hpp"

namespace hitchview::calib {
namespace {

using Reasons = std::vector<std::string>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kFewestShots = 3;
constexpr double kLeastSpread_rad = 20 * kDegree;
constexpr double kMostStraight_rad = 0.5 * kDegree;
constexpr double kMostSigma_m = 0.005;
constexpr double kMostSigma_rad = 0.05 * kDegree;
constexpr double kMostRms_px = 1.0;

void JudgeShots(const HitchSolution& solution, Reasons& reasons) {
    if (solution.shots.size() < kFewestShots)
        reasons.push_back(Sentence("only %zu shots show both units, at least %zu are needed",
                                   solution.shots.size(), kFewestShots));
    const auto [least, most] =
        std::ranges::minmax_element(solution.shots, {}, &ShotArticulation::yaw_rad);
    const double spread_rad = most->yaw_rad - least->yaw_rad;
    if (spread_rad < kLeastSpread_rad)
        reasons.push_back(Sentence(
            "the trailer is turned by %.1f degrees between the shots: turn by at least %.0f "
            "degrees, better to both sides",
            spread_rad / kDegree, kLeastSpread_rad / kDegree));
}

void JudgeStraight(const HitchProblem& problem, const HitchSolution& solution, Reasons& reasons) {
    if (!solution.straight_sigma_rad) {
        reasons.emplace_back(
            "no shot is said to be straight: yaw 0 is where the units' own frames are parallel; "
            "take one with the units in line and name it with --straight");
        return;
    }
    for (const ShotArticulation& shot : solution.shots) {
        const bool straight =
            std::ranges::find(problem.straight, shot.shot) != problem.straight.end();
        if (straight && std::abs(shot.yaw_rad) > kMostStraight_rad / 2)
            reasons.push_back(Sentence(
                "straight shot %s is %.2f degrees from the mean of the straight ones: name "
                "only those in which the units are in line",
                shot.shot.c_str(), shot.yaw_rad / kDegree));
    }
    if (*solution.straight_sigma_rad > kMostSigma_rad)
        reasons.push_back(Sentence(
            "the straight yaw is known to %.3f degrees only (standard deviation), %.2f are "
            "needed: more straight shots, or more targets that both units see",
            *solution.straight_sigma_rad / kDegree, kMostSigma_rad / kDegree));
}

void JudgeSightings(const HitchProblem& problem, const HitchSolution& solution, Reasons& reasons) {
    for (const std::size_t i : solution.outliers) {
        const Sighting& sighting = problem.sightings[i];
        reasons.push_back(Sentence(
            "%s in shot %s of %s does not fit the others: look at the picture, leave it out if the "
            "target or the vehicle moved",
            problem.targets[sighting.target].name.c_str(), sighting.shot.c_str(),
            problem.names[sighting.camera].c_str()));
    }
}

void JudgePoint(const HitchSolution& solution, Reasons& reasons) {
    const double sigma_m = std::max(solution.sigma_tractor_m.head<2>().maxCoeff(),
                                    solution.sigma_trailer_m.head<2>().maxCoeff());
    if (sigma_m > kMostSigma_m)
        reasons.push_back(Sentence(
            "the hitch point is known to %.1f mm only (standard deviation), %.0f are needed: turn "
            "further, take more shots, or put up more targets",
            1000 * sigma_m, 1000 * kMostSigma_m));
    if (!(solution.rms_px <= kMostRms_px))
        reasons.push_back(Sentence(
            "the corners are %.2f px off on average, at most %.1f may be: did a target or the "
            "vehicle move within a shot, or a camera since it was calibrated?",
            solution.rms_px, kMostRms_px));
}

}  // namespace

std::string HitchLimits() {
    return Sentence(
        "%zu shots, turned by %.0f degrees, rms %.3g px, known to %.3g degrees and %.3g mm",
        kFewestShots, kLeastSpread_rad / kDegree, kMostRms_px, kMostSigma_rad / kDegree,
        1000 * kMostSigma_m);
}

std::vector<std::string> JudgeHitch(const HitchProblem& problem, const HitchSolution& solution) {
    Reasons reasons;
    JudgeShots(solution, reasons);
    JudgeStraight(problem, solution, reasons);
    JudgeSightings(problem, solution, reasons);
    JudgePoint(solution, reasons);
    return reasons;
}

}  // namespace hitchview::calib
