#include "calib/camera_graph.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>

#include "calib/text.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFewestCorners = 6;

/// Whether the points spread in two directions: their standard deviation across the line that fits
/// best is at least a twentieth of that along it.
bool SpreadOverPlane(std::span<const Vector3d> points) {
    constexpr double kLeastShare = 0.05;
    if (points.size() < 3) return false;
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
    const Vector3d spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
    return spread[1] > kLeastShare * kLeastShare * spread[2];
}

bool EnoughCorners(const Board& board, const SeenCorners& corners) {
    std::vector<Vector3d> points;
    for (const SeenCorner& corner : corners) points.push_back(board.Corner(corner.index));
    return points.size() >= kFewestCorners && SpreadOverPlane(points);
}

/// Groups of things that hang together.
class Groups {
 public:
    explicit Groups(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    std::size_t Of(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void Join(std::size_t a, std::size_t b) { parent_[Of(a)] = Of(b); }

 private:
    std::vector<std::size_t> parent_;
};

double AngleBetween(double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi));
}

/// Finds what is missing. Vertices of the graph: cameras, then nodes, then the unit frame.
class Examination {
 public:
    Examination(const UnitProblem& problem, CameraGraph& graph)
        : problem_(problem), graph_(graph), groups_(0), sightings_of_(problem.cameras.size(), 0) {
        AddSightings();
        groups_ = Groups(problem.cameras.size() + graph.nodes.size() + 1);
        Tie();
    }

    void Report() {
        if (!fixed_) {
            graph_.missing.emplace_back(
                "the unit frame is not fixed: survey at least three corners of a target that a "
                "camera sees, or measure a camera's pose");
        }
        for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
            if (sightings_of_[i] == 0 && !problem_.cameras[i].pose) MissTargets(i);
        }
        for (const auto& [group, cameras] : CamerasByGroup()) {
            if (group != groups_.Of(UnitFrame())) MissLink(cameras);
        }
        graph_.text = Text();
    }

 private:
    [[nodiscard]] std::size_t UnitFrame() const {
        return problem_.cameras.size() + graph_.nodes.size();
    }

    void AddSightings() {
        std::map<std::pair<std::size_t, std::string>, std::size_t> known;
        for (const Sighting& sighting : problem_.sightings) {
            const UnitTarget& target = problem_.targets[sighting.target];
            if (!EnoughCorners(target.board, sighting.corners)) {
                Pass(sighting);
                continue;
            }
            const std::string shot = target.moves ? sighting.shot : "";
            const auto [at, fresh] = known.try_emplace({sighting.target, shot}, known.size());
            if (fresh) graph_.nodes.push_back({sighting.target, shot});
            graph_.node_of.emplace_back(at->second);
            ++sightings_of_[sighting.camera];
        }
    }

    void Pass(const Sighting& sighting) {
        graph_.node_of.emplace_back();
        graph_.notes.push_back(Sentence(
            "%s sees too little of %s in %s: %zu corners, at least %zu that are not in one line "
            "are needed",
            Camera(sighting.camera).c_str(), problem_.targets[sighting.target].name.c_str(),
            sighting.shot.c_str(), sighting.corners.size(), kFewestCorners));
    }

    void Tie() {
        for (std::size_t i = 0; i < problem_.sightings.size(); ++i) {
            if (graph_.node_of[i])
                groups_.Join(problem_.sightings[i].camera,
                             problem_.cameras.size() + *graph_.node_of[i]);
        }
        for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
            if (problem_.cameras[i].pose) Fix(i);
        }
        for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
            if (PlaceIsSurveyed(problem_.targets[graph_.nodes[i].target]))
                Fix(problem_.cameras.size() + i);
        }
    }

    void Fix(std::size_t vertex) {
        groups_.Join(vertex, UnitFrame());
        fixed_ = true;
    }

    [[nodiscard]] const std::string& Camera(std::size_t i) const {
        return problem_.cameras[i].name;
    }

    void MissTargets(std::size_t camera) {
        graph_.missing.push_back(
            Sentence("%s sees no target in any picture: put one where it sees it, or look whether "
                     "its pictures are the right ones",
                     Camera(camera).c_str()));
    }

    /// Groups of cameras that see something.
    std::map<std::size_t, std::vector<std::size_t>> CamerasByGroup() {
        std::map<std::size_t, std::vector<std::size_t>> cameras;
        for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
            if (sightings_of_[i] > 0) cameras[groups_.Of(i)].push_back(i);
        }
        return cameras;
    }

    void MissLink(const std::vector<std::size_t>& group) {
        std::string names;
        for (const std::size_t camera : group)
            names += (names.empty() ? "" : ", ") + Camera(camera);
        const std::string hang = names + (group.size() == 1 ? " hangs" : " hang together, but") +
                                 " on nothing that was surveyed or measured: ";
        const auto link = NearestOutside(group);
        const std::string put = link ? "put a target where " + Camera(link->first) + " and " +
                                           Camera(link->second) + " both see it, or "
                                     : "";
        graph_.missing.push_back(hang + put + "survey three corners of " + TargetsOf(group));
    }

    /// The camera of the group and the one outside it, tied to the unit frame where there is such a
    /// one, whose directions are nearest.
    std::optional<std::pair<std::size_t, std::size_t>> NearestOutside(
        const std::vector<std::size_t>& group) {
        std::optional<std::pair<std::size_t, std::size_t>> nearest;
        double least = 1e9;
        for (const std::size_t inside : group) {
            for (std::size_t other = 0; other < problem_.cameras.size(); ++other) {
                if (groups_.Of(other) == groups_.Of(inside)) continue;
                const bool tied = groups_.Of(other) == groups_.Of(UnitFrame());
                const double angle = AngleBetween(problem_.cameras[inside].yaw_rad,
                                                  problem_.cameras[other].yaw_rad) +
                                     (tied || !fixed_ ? 0 : 10);
                if (angle >= least) continue;
                least = angle;
                nearest = {inside, other};
            }
        }
        return nearest;
    }

    std::string TargetsOf(const std::vector<std::size_t>& group) {
        std::string names;
        for (const TargetNode& node : graph_.nodes) {
            const auto vertex =
                problem_.cameras.size() + static_cast<std::size_t>(&node - graph_.nodes.data());
            const UnitTarget& target = problem_.targets[node.target];
            if (groups_.Of(vertex) != groups_.Of(group.front()) || target.moves) continue;
            names += (names.empty() ? "" : " or ") + target.name;
        }
        return names.empty() ? "a target that stands still before it" : names;
    }

    std::string Text() {
        std::string text = "unit frame: " + Ties() + "\n";
        for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
            text += Camera(i) + ":";
            const std::string seen = SeenBy(i);
            text += (seen.empty() ? " nothing" : seen) +
                    (groups_.Of(i) == groups_.Of(UnitFrame()) ? "" : "  (not tied)") + "\n";
        }
        return text;
    }

    std::string Ties() {
        std::string ties;
        for (const UnitTarget& target : problem_.targets) {
            if (!target.surveyed.empty())
                ties += Sentence(" %s (%zu corners)", target.name.c_str(), target.surveyed.size());
        }
        for (const UnitCamera& camera : problem_.cameras) {
            if (camera.pose) ties += " " + camera.name + " (pose)";
        }
        return ties.empty() ? "nothing" : ties.substr(1);
    }

    std::string SeenBy(std::size_t camera) {
        std::map<std::string, std::pair<int, std::size_t>> seen;
        for (std::size_t i = 0; i < problem_.sightings.size(); ++i) {
            const Sighting& sighting = problem_.sightings[i];
            if (sighting.camera != camera || !graph_.node_of[i]) continue;
            auto& [pictures, corners] = seen[problem_.targets[sighting.target].name];
            ++pictures;
            corners += sighting.corners.size();
        }
        std::string text;
        for (const auto& [name, count] : seen)
            text += Sentence("  %s (%d pictures, %zu corners)", name.c_str(), count.first,
                             count.second);
        return text;
    }

    const UnitProblem& problem_;
    CameraGraph& graph_;
    Groups groups_;
    std::vector<std::size_t> sightings_of_;
    bool fixed_ = false;
};

}  // namespace

bool PlaceIsSurveyed(const UnitTarget& target) {
    std::vector<Vector3d> points;
    for (const SurveyedCorner& corner : target.surveyed) points.push_back(corner.p_board_m);
    return SpreadOverPlane(points);
}

CameraGraph BuildCameraGraph(const UnitProblem& problem) {
    CameraGraph graph;
    Examination(problem, graph).Report();
    return graph;
}

}  // namespace hitchview::calib
