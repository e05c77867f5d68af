#include "calib/verification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/lens_solver.hpp"
#include "calib/moved_cameras.hpp"
#include "calib/text.hpp"

namespace hitchview::calib {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMostMisaligned_rad = 0.25 * kDegree;
constexpr double kMostRms_px = 1.5;

class UnitChecks {
 public:
    UnitChecks(const UnitProblem& problem, double px_per_rad)
        : problem_(problem), px_per_rad_(px_per_rad), pairs_(MeasurePairTurns(problem)) {}

    std::vector<Check> Run() {
        for (std::size_t i = 0; i < problem_.cameras.size(); ++i) CheckLens(i);
        for (const PairTurn& pair : pairs_) CheckPair(pair);
        if (problem_.cameras.size() > 1) {
            for (std::size_t i = 0; i < problem_.cameras.size(); ++i) CheckSeen(i);
        }
        CheckMoves();
        return std::move(checks_);
    }

 private:
    [[nodiscard]] const std::string& Name(std::size_t camera) const {
        return problem_.cameras[camera].name;
    }

    [[nodiscard]] double RmsOf(const Sighting& sighting) const {
        const algo::CameraModel& lens = problem_.cameras[sighting.camera].model;
        const auto board_m = problem_.targets[sighting.target].board.Corners();
        const auto place = SolvePlace(lens, board_m, sighting.corners);
        if (!place) return std::numeric_limits<double>::infinity();
        return std::sqrt(SquaredErrors(lens, board_m, *place, sighting.corners) /
                         static_cast<double>(sighting.corners.size()));
    }

    void CheckLens(std::size_t camera) {
        double worst_px = -1;
        for (const Sighting& sighting : problem_.sightings)
            if (sighting.camera == camera) worst_px = std::max(worst_px, RmsOf(sighting));
        if (worst_px < 0) return;
        Check check{.name = Name(camera) + ": boards through its lens",
                    .figure = worst_px,
                    .limit = kMostRms_px,
                    .unit = "px",
                    .ok = worst_px <= kMostRms_px};
        if (!check.ok)
            check.reason =
                "the lens is not as it was measured, or a board is not as it was said: "
                "measure the lens again";
        checks_.push_back(std::move(check));
    }

    void CheckPair(const PairTurn& pair) {
        const double shift_rad = pair.Misalignment_rad();
        Check check{.name = Name(pair.first) + " and " + Name(pair.second) + ": misalignment",
                    .figure = shift_rad * px_per_rad_,
                    .limit = kMostMisaligned_rad * px_per_rad_,
                    .unit = "px of the panorama",
                    .ok = shift_rad <= kMostMisaligned_rad};
        if (!check.ok)
            check.reason = Sentence(
                "what both see (%zu points, on %zu boards and far away) is %.2f degrees apart",
                pair.sights.size(), pair.boards, shift_rad / kDegree);
        checks_.push_back(std::move(check));
    }

    void CheckSeen(std::size_t camera) {
        const auto pairs = std::ranges::count_if(pairs_, [&](const PairTurn& pair) {
            return pair.first == camera || pair.second == camera;
        });
        Check check{.name = Name(camera) + ": neighbours that see the same",
                    .figure = static_cast<double>(pairs),
                    .ok = pairs > 0};
        if (!check.ok)
            check.reason =
                "nothing in the pictures tells whether it still stands where it did: show a board "
                "to it and a neighbour at once, or take pictures where there is more to see far "
                "away";
        checks_.push_back(std::move(check));
    }

    void CheckMoves() {
        if (pairs_.empty()) return;
        const auto answers = ExplainByMoves(problem_.cameras.size(), pairs_, kMostMisaligned_rad);
        std::size_t fewest = answers.empty() ? problem_.cameras.size() : answers[0].size();
        Check check{.name = "cameras that moved",
                    .figure = static_cast<double>(fewest),
                    .limit = 0,
                    .ok = !answers.empty() && fewest == 0};
        if (!check.ok) check.reason = WhoMoved(answers);
        checks_.push_back(std::move(check));
    }

    [[nodiscard]] std::string WhoMoved(const std::vector<std::vector<MovedCamera>>& answers) const {
        if (answers.empty()) return "no few cameras explain it: calibrate the whole unit again";
        std::string who;
        for (const auto& answer : answers) {
            if (!who.empty()) who += ", or ";
            for (std::size_t i = 0; i < answer.size(); ++i) {
                who +=
                    (i > 0 ? " and " : "") + Name(answer[i].camera) +
                    Sentence(" moved (turned by some %.1f degrees)", answer[i].turn_rad / kDegree);
            }
        }
        return who + ": tighten its mount and calibrate the unit again";
    }

    const UnitProblem& problem_;
    const double px_per_rad_;
    const std::vector<PairTurn> pairs_;
    std::vector<Check> checks_{};
};

}  // namespace

std::vector<Check> CheckUnit(const UnitProblem& problem, double panorama_px_per_rad) {
    return UnitChecks(problem, panorama_px_per_rad).Run();
}

std::vector<Check> CheckHoles(const std::vector<SeamHole>& holes) {
    std::vector<Check> checks;
    for (const SeamHole& hole : holes) {
        const std::string seam = "between " + hole.right + " and " + hole.left;
        Check check{.name = seam + ": gap at the horizon",
                    .figure = static_cast<double>(hole.gap_at_horizon_px),
                    .limit = 0,
                    .unit = "columns",
                    .ok = hole.gap_at_horizon_px == 0};
        if (!check.ok)
            check.reason =
                "no camera sees there: turn the cameras towards each other, or put one "
                "between them";
        checks.push_back(std::move(check));
        checks.push_back({.name = seam + ": uncovered",
                          .figure = static_cast<double>(hole.uncovered_px),
                          .unit = "px of the panorama"});
    }
    return checks;
}

}  // namespace hitchview::calib
