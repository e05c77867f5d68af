#include "calib/unit_changes.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <numbers>
#include <span>

#include "calib/place_change.hpp"
#include "calib/text.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSuspicious = 60;  // chi squared, 6 degrees of freedom
constexpr double kLeastTurn_rad = 0.05 * kDegree;
constexpr double kLeastShift_m = 0.005;
constexpr double kLeastSize = 0.005;
/// One step from errors that count less goes part of the way.
constexpr double kLeastSizeStep = 0.001;
constexpr double kSizeSigmas = 5;
constexpr double kMostLeft = 0.8;
constexpr double kNearlyAsGood = 1.05;
constexpr std::size_t kMostChanges = 3;

/// A problem in which something is another thing from some shot on.
struct Split {
    UnitProblem problem;
    CameraGraph graph;
    UnitPlaces places;
};

/// One place in one shot, as a change of its place in all of them.
struct ShotPlace {
    std::string shot;
    Vector6 change;
    Matrix6 information;
};

/// Means of two groups of places, and by how much more they differ than their errors allow.
struct Difference {
    Vector6 change = Vector6::Zero();
    double chi_squared = 0;
};

Difference Between(std::span<const ShotPlace> early, std::span<const ShotPlace> late) {
    const auto mean = [](std::span<const ShotPlace> places, Matrix6& information) {
        information.setZero();
        Vector6 sum = Vector6::Zero();
        for (const ShotPlace& place : places) {
            information += place.information;
            sum += place.information * place.change;
        }
        return Vector6(information.ldlt().solve(sum));
    };
    Matrix6 of_early;
    Matrix6 of_late;
    const Vector6 change = mean(late, of_late) - mean(early, of_early);
    const Matrix6 covariance = of_early.inverse() + of_late.inverse();
    return {change, change.dot(covariance.ldlt().solve(change))};
}

/// Looks for changes of one problem.
class Search {
 public:
    Search(const UnitProblem& problem, const CameraGraph& graph, const UnitPlaces& places,
           double sigma_px)
        : problem_(problem),
          graph_(graph),
          places_(places),
          all_(AllCorners(problem, graph)),
          sigma_px_(sigma_px) {
        cost_ = Adjust(problem, graph, places_, {});
    }

    /// The change that explains most, and the problem with it.
    std::optional<std::pair<UnitChange, Split>> Best() {
        std::vector<std::pair<UnitChange, Split>> found;
        for (const UnitChange& suspect : Suspects()) {
            Split split = With(suspect);
            std::optional<std::size_t> free_size;
            if (suspect.kind == UnitChange::Kind::kWrongSize) free_size = suspect.index;
            const double cost = Adjust(split.problem, split.graph, split.places, free_size);
            UnitChange change = Measured(suspect, split);
            change.share_left = cost / cost_;
            if (change.share_left > kMostLeft) continue;
            if (free_size && std::abs(change.size - 1) < kLeastSize) continue;
            found.emplace_back(change, std::move(split));
        }
        const auto share_left = [](const auto& one) { return one.first.share_left; };
        const auto best = std::ranges::min_element(found, {}, share_left);
        if (best == found.end()) return std::nullopt;
        for (const auto& other : found) {
            if (&other != &*best && share_left(other) < kNearlyAsGood * share_left(*best))
                best->first.rival = other.first.name;
        }
        return std::move(*best);
    }

 private:
    double Adjust(const UnitProblem& problem, const CameraGraph& graph, UnitPlaces& places,
                  std::optional<std::size_t> free_size) const {
        UnitAdjustment adjustment(problem, graph, AllCorners(problem, graph),
                                  {.sigma_px = sigma_px_, .robust = true, .free_size = free_size},
                                  places);
        adjustment.Solve();
        return adjustment.cost();
    }

    std::vector<UnitChange> Suspects() {
        std::vector<UnitChange> suspects;
        for (std::size_t vertex = 0; vertex < problem_.cameras.size() + graph_.nodes.size();
             ++vertex) {
            if (const auto moved = Moved(vertex)) suspects.push_back(*moved);
        }
        for (std::size_t target = 0; target < problem_.targets.size(); ++target) {
            if (const auto wrong = WrongSize(target)) suspects.push_back(*wrong);
        }
        return suspects;
    }

    [[nodiscard]] bool IsCamera(std::size_t vertex) const {
        return vertex < problem_.cameras.size();
    }
    [[nodiscard]] std::size_t NodeOf(std::size_t vertex) const {
        return vertex - problem_.cameras.size();
    }

    /// Whether a sighting tells where a vertex is in its shot.
    [[nodiscard]] bool Tells(std::size_t sighting, std::size_t vertex) const {
        const auto node = graph_.node_of[sighting];
        if (!node || problem_.targets[problem_.sightings[sighting].target].moves) return false;
        return IsCamera(vertex) ? problem_.sightings[sighting].camera == vertex
                                : *node == NodeOf(vertex);
    }

    std::optional<UnitChange> Moved(std::size_t vertex) {
        const std::vector<ShotPlace> shots = PlacesByShot(vertex);
        Difference most;
        std::size_t at = 0;
        for (std::size_t i = 1; i < shots.size(); ++i) {
            const auto all = std::span(shots);
            const Difference difference = Between(all.first(i), all.subspan(i));
            if (difference.chi_squared <= most.chi_squared) continue;
            most = difference;
            at = i;
        }
        const bool far = most.change.head<3>().norm() > kLeastTurn_rad ||
                         most.change.tail<3>().norm() > kLeastShift_m;
        if (most.chi_squared < kSuspicious || !far) return std::nullopt;
        UnitChange change{.kind = IsCamera(vertex) ? UnitChange::Kind::kCameraMoved
                                                   : UnitChange::Kind::kTargetMoved,
                          .index = IsCamera(vertex) ? vertex : NodeOf(vertex)};
        change.last_before = shots[at - 1].shot;
        change.first_after = shots[at].shot;
        return change;
    }

    /// In the order of the shots; all other places as they are.
    std::vector<ShotPlace> PlacesByShot(std::size_t vertex) {
        std::map<std::string, KeptCorners> by_shot;
        for (std::size_t i = 0; i < problem_.sightings.size(); ++i) {
            if (!Tells(i, vertex)) continue;
            const auto [kept, fresh] =
                by_shot.try_emplace(problem_.sightings[i].shot, KeptCorners(all_.size()));
            kept->second[i] = all_[i];
        }
        std::vector<ShotPlace> places;
        if (by_shot.size() < 2) return places;
        for (const auto& [shot, kept] : by_shot) {
            if (const auto place = PlaceIn(vertex, kept)) {
                places.push_back(*place);
                places.back().shot = shot;
            }
        }
        return places;
    }

    std::optional<ShotPlace> PlaceIn(std::size_t vertex, const KeptCorners& kept) {
        UnitPlaces places = places_;
        UnitAdjustmentOptions options{.sigma_px = sigma_px_, .robust = true, .only = vertex};
        if (!UnitAdjustment(problem_, graph_, kept, options, places).Solve()) return std::nullopt;
        options.robust = false;
        const auto found = UnitAdjustment(problem_, graph_, kept, options, places).Information();
        if (!found) return std::nullopt;
        const double scale = std::max(1.0, found->pixel_scale);
        return ShotPlace{"", ChangeOf(vertex, places),
                         Matrix6(found->covariance.inverse() / (scale * scale))};
    }

    [[nodiscard]] static const Isometry3d& PlaceOf(const UnitPlaces& places, std::size_t vertex) {
        const std::size_t cameras = places.T_unit_camera.size();
        return vertex < cameras ? places.T_unit_camera[vertex]
                                : places.T_unit_target[vertex - cameras];
    }

    [[nodiscard]] Vector6 ChangeOf(std::size_t vertex, const UnitPlaces& places) const {
        const Isometry3d& early = PlaceOf(places_, vertex);
        const Isometry3d& late = PlaceOf(places, vertex);
        const Eigen::AngleAxisd turn(early.linear().transpose() * late.linear());
        Vector6 change;
        change << turn.angle() * turn.axis(), late.translation() - early.translation();
        return change;
    }

    std::optional<UnitChange> WrongSize(std::size_t target) {
        const UnitAdjustmentOptions options{
            .sigma_px = sigma_px_, .robust = true, .free_size = target};
        const auto found = UnitAdjustment(problem_, graph_, all_, options, places_).Information();
        if (!found) return std::nullopt;
        const double sigma = std::sqrt(found->covariance.diagonal().tail<1>()[0]);
        const double off = std::abs(found->step.tail<1>()[0]);
        if (off < kLeastSizeStep || off < kSizeSigmas * sigma) return std::nullopt;
        return UnitChange{.kind = UnitChange::Kind::kWrongSize, .index = target};
    }

    /// The problem with a change in it; not solved.
    [[nodiscard]] Split With(const UnitChange& change) const {
        Split split{problem_, graph_, places_};
        if (change.kind == UnitChange::Kind::kCameraMoved) {
            UnitCamera after = problem_.cameras[change.index];
            after.pose.reset();
            split.problem.cameras.push_back(after);
            split.places.T_unit_camera.push_back(places_.T_unit_camera[change.index]);
            for (Sighting& sighting : split.problem.sightings) {
                if (sighting.camera == change.index && sighting.shot >= change.first_after)
                    sighting.camera = problem_.cameras.size();
            }
        } else if (change.kind == UnitChange::Kind::kTargetMoved) {
            split.graph.nodes.push_back({graph_.nodes[change.index].target, change.first_after});
            split.places.T_unit_target.push_back(places_.T_unit_target[change.index]);
            for (std::size_t i = 0; i < problem_.sightings.size(); ++i) {
                if (graph_.node_of[i] == change.index &&
                    problem_.sightings[i].shot >= change.first_after)
                    split.graph.node_of[i] = graph_.nodes.size();
            }
        }
        return split;
    }

    /// `change`, as the solved problem with it tells.
    [[nodiscard]] UnitChange Measured(UnitChange change, const Split& split) const {
        if (change.kind == UnitChange::Kind::kWrongSize) {
            change.name = problem_.targets[change.index].name;
            change.size = split.places.size[change.index];
            return change;
        }
        const bool camera = change.kind == UnitChange::Kind::kCameraMoved;
        const auto& places = camera ? split.places.T_unit_camera : split.places.T_unit_target;
        const Isometry3d moved = places[change.index].inverse() * places.back();
        change.turn_rad = Eigen::AngleAxisd(moved.linear()).angle();
        change.shift_m = moved.translation().norm();
        change.name = camera ? problem_.cameras[change.index].name
                             : problem_.targets[graph_.nodes[change.index].target].name;
        return change;
    }

    const UnitProblem& problem_;
    const CameraGraph& graph_;
    UnitPlaces places_;
    KeptCorners all_;
    double sigma_px_;
    double cost_ = 0;
};

}  // namespace

std::vector<UnitChange> FindChanges(const UnitProblem& problem, const CameraGraph& graph,
                                    const UnitSolution& solution) {
    std::vector<UnitChange> changes;
    Split now{problem, graph, solution.places};
    while (changes.size() < kMostChanges) {
        auto best = Search(now.problem, now.graph, now.places, solution.sigma_px).Best();
        if (!best) break;
        changes.push_back(best->first);
        now = std::move(best->second);
    }
    return changes;
}

std::string Describe(const UnitChange& change) {
    const std::string rival = change.rival.empty() ? "" : " (or it was " + change.rival + ")";
    if (change.kind == UnitChange::Kind::kWrongSize) {
        return Sentence("%s is %.1f %% %s than its board says%s: measure the board again",
                        change.name.c_str(), 100 * std::abs(change.size - 1),
                        change.size > 1 ? "larger" : "smaller", rival.c_str());
    }
    const bool camera = change.kind == UnitChange::Kind::kCameraMoved;
    return Sentence("%s %s moved between the shots %s and %s, by %.2f degrees and %.0f mm%s: %s",
                    camera ? "camera" : "target", change.name.c_str(), change.last_before.c_str(),
                    change.first_after.c_str(), change.turn_rad / kDegree, 1000 * change.shift_m,
                    rival.c_str(),
                    camera ? "fix it, and take all pictures again"
                           : "say moves: true, or leave out the pictures on one side");
}

}  // namespace hitchview::calib
