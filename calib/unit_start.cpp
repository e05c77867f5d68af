#include "calib/unit_start.hpp"

#include <algorithm>
#include <limits>

#include "calib/lens_solver.hpp"
#include "calib/reprojection_error.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// A place of a board that explains one picture of it.
struct Candidate {
    Isometry3d T_camera_board;
    double squared_px;
};

/// The place that looks most like `T_camera_board`: the board tilted to the other side of the ray
/// to its middle.
Isometry3d TiltedTheOtherWay(const Isometry3d& T_camera_board, const Vector3d& middle_m) {
    const Vector3d middle = T_camera_board * middle_m;
    Isometry3d other = Isometry3d::Identity();
    other.linear() = Eigen::AngleAxisd(std::numbers::pi, middle.normalized()) *
                     T_camera_board.linear() *
                     Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()).toRotationMatrix();
    other.translation() = middle - other.linear() * middle_m;
    return other;
}

std::optional<Isometry3d> Refined(const algo::CameraModel& model, const Points& board_m,
                                  const SeenCorners& corners, const Isometry3d& start) {
    PlaceParameters place = Parameters(start);
    const LensParameters lens(model);
    ceres::Problem problem;
    for (const SeenCorner& corner : corners) {
        const Vector3d& at_m = board_m[static_cast<std::size_t>(corner.index)];
        problem.AddResidualBlock(PlaceError::Create(lens, at_m, corner.at_px), nullptr,
                                 place.data());
    }
    ceres::Solver::Options settings = SolverSettings();
    settings.max_num_iterations = 20;
    ceres::Solver::Summary summary;
    ceres::Solve(settings, &problem, &summary);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    return Place(place);
}

/// The best first; at most two.
std::vector<Candidate> Candidates(const algo::CameraModel& model, const Points& board_m,
                                  const SeenCorners& corners) {
    std::vector<Candidate> candidates;
    const auto add = [&](const std::optional<Isometry3d>& place) {
        if (!place) return;
        const double squared_px = SquaredErrors(model, board_m, *place, corners);
        if (std::isfinite(squared_px)) candidates.push_back({*place, squared_px});
    };
    const auto first = SolvePlace(model, board_m, corners);
    add(first);
    if (!first) return candidates;
    Vector3d middle_m = Vector3d::Zero();
    for (const SeenCorner& corner : corners)
        middle_m += board_m[static_cast<std::size_t>(corner.index)];
    middle_m /= static_cast<double>(corners.size());
    add(Refined(model, board_m, corners, TiltedTheOtherWay(*first, middle_m)));
    std::ranges::sort(candidates, {}, &Candidate::squared_px);
    return candidates;
}

/// Grows from what is known. Vertices: cameras, then nodes.
class Growth {
 public:
    Growth(const UnitProblem& problem, const CameraGraph& graph)
        : problem_(problem), graph_(graph), places_(problem.cameras.size() + graph.nodes.size()) {
        for (const UnitTarget& target : problem.targets)
            boards_m_.push_back(target.board.Corners());
        for (std::size_t i = 0; i < problem.sightings.size(); ++i)
            if (graph.node_of[i]) AddEdge(i);
    }

    std::optional<UnitPlaces> Run() {
        PlaceSurveyed();
        GrowAll();
        for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
            if (places_[i] || !problem_.cameras[i].pose) continue;
            places_[i] = problem_.cameras[i].pose->T_unit_camera;
            GrowAll();
        }
        constexpr int kRepairs = 2;
        for (int i = 0; i < kRepairs; ++i) Repair();
        return Result();
    }

 private:
    struct Edge {
        std::size_t sighting;
        std::size_t camera;
        std::size_t node;  ///< as a vertex
        std::vector<Candidate> candidates;

        /// How much better the best candidate is than the other.
        [[nodiscard]] double Certainty() const {
            if (candidates.empty()) return 0;
            return candidates.size() < 2
                       ? 1e9
                       : (candidates[1].squared_px + 1) / (candidates[0].squared_px + 1);
        }
    };

    void AddEdge(std::size_t i) {
        const Sighting& sighting = problem_.sightings[i];
        edges_.push_back({i, sighting.camera, problem_.cameras.size() + *graph_.node_of[i],
                          Candidates(problem_.cameras[sighting.camera].model,
                                     boards_m_[sighting.target], sighting.corners)});
    }

    void PlaceSurveyed() {
        for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
            const UnitTarget& target = problem_.targets[graph_.nodes[i].target];
            if (!PlaceIsSurveyed(target)) continue;
            Eigen::Matrix3Xd from(3, std::ssize(target.surveyed));
            Eigen::Matrix3Xd to(3, std::ssize(target.surveyed));
            for (int k = 0; k < from.cols(); ++k) {
                from.col(k) = target.surveyed[static_cast<std::size_t>(k)].p_board_m;
                to.col(k) = target.surveyed[static_cast<std::size_t>(k)].p_unit_m;
            }
            Isometry3d& place = places_[problem_.cameras.size() + i].emplace();
            place.matrix() = Eigen::umeyama(from, to, false);
        }
    }

    /// The most certain sighting between a vertex with and one without a place, again and again.
    void GrowAll() {
        while (true) {
            const Edge* best = nullptr;
            for (const Edge& edge : edges_) {
                if (places_[edge.camera].has_value() == places_[edge.node].has_value()) continue;
                if (edge.candidates.empty()) continue;
                if (best == nullptr || edge.Certainty() > best->Certainty()) best = &edge;
            }
            if (best == nullptr) return;
            const std::size_t vertex = places_[best->camera] ? best->node : best->camera;
            places_[vertex] = BestPlace(vertex);
        }
    }

    /// Once more for each vertex, now that its neighbours have places.
    void Repair() {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const bool surveyed =
                i >= problem_.cameras.size() && PlaceIsSurveyed(problem_.targets[Node(i).target]);
            if (surveyed || !places_[i]) continue;
            const auto other = BestPlace(i);
            constexpr double kClearly = 0.9;
            if (other && Misfit(i, *other) < kClearly * Misfit(i, *places_[i])) places_[i] = other;
        }
    }

    [[nodiscard]] const TargetNode& Node(std::size_t vertex) const {
        return graph_.nodes[vertex - problem_.cameras.size()];
    }

    std::optional<Isometry3d> BestPlace(std::size_t vertex) {
        std::optional<Isometry3d> best;
        double least = std::numeric_limits<double>::infinity();
        for (const Edge& edge : edges_) {
            const bool is_camera = edge.camera == vertex;
            const std::size_t other = is_camera ? edge.node : edge.camera;
            if ((!is_camera && edge.node != vertex) || !places_[other]) continue;
            for (const Candidate& candidate : edge.candidates) {
                const Isometry3d place =
                    *places_[other] *
                    (is_camera ? candidate.T_camera_board.inverse() : candidate.T_camera_board);
                const double misfit = Misfit(vertex, place);
                if (misfit >= least) continue;
                least = misfit;
                best = place;
            }
        }
        return best;
    }

    /// Squared errors in all sightings of a vertex by or of something that has a place; none counts
    /// more than a wrong one does.
    double Misfit(std::size_t vertex, const Isometry3d& place) {
        constexpr double kWrong_px = 30;
        double sum = 0;
        for (const Edge& edge : edges_) {
            const bool is_camera = edge.camera == vertex;
            const std::size_t other = is_camera ? edge.node : edge.camera;
            if ((!is_camera && edge.node != vertex) || !places_[other]) continue;
            const Isometry3d& camera = is_camera ? place : *places_[other];
            const Isometry3d& target = is_camera ? *places_[other] : place;
            const Sighting& sighting = problem_.sightings[edge.sighting];
            const double most =
                kWrong_px * kWrong_px * static_cast<double>(sighting.corners.size());
            sum += std::min(
                most, SquaredErrors(problem_.cameras[edge.camera].model, boards_m_[sighting.target],
                                    camera.inverse() * target, sighting.corners));
        }
        return sum;
    }

    std::optional<UnitPlaces> Result() {
        UnitPlaces result;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (!places_[i]) return std::nullopt;
            (i < problem_.cameras.size() ? result.T_unit_camera : result.T_unit_target)
                .push_back(*places_[i]);
        }
        result.size.assign(problem_.targets.size(), 1.0);
        return result;
    }

    const UnitProblem& problem_;
    const CameraGraph& graph_;
    std::vector<Points> boards_m_;
    std::vector<std::optional<Isometry3d>> places_;
    std::vector<Edge> edges_;
};

}  // namespace

std::optional<UnitPlaces> FirstPlaces(const UnitProblem& problem, const CameraGraph& graph) {
    return Growth(problem, graph).Run();
}

}  // namespace hitchview::calib
