#include "calib/pose_graph.hpp"

#include <algorithm>
#include <cmath>
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

/// Grows from what is known. Vertices: bodies, then targets.
class Growth {
 public:
    explicit Growth(PoseGraph& graph) : graph_(graph), places_(graph.bodies) {
        places_.insert(places_.end(), graph.targets.begin(), graph.targets.end());
        for (const BodySighting& sighting : graph.sightings)
            edges_.push_back({&sighting, graph.bodies.size() + sighting.target,
                              Candidates(sighting.model, sighting.board_m, sighting.corners)});
    }

    void Run() {
        GrowAll();
        for (std::size_t i = 0; i < graph_.fallbacks.size(); ++i) {
            if (places_[i] || !graph_.fallbacks[i]) continue;
            places_[i] = graph_.fallbacks[i];
            GrowAll();
        }
        constexpr int kRepairs = 2;
        for (int i = 0; i < kRepairs; ++i) Repair();
        const auto middle = places_.begin() + std::ssize(graph_.bodies);
        std::copy(places_.begin(), middle, graph_.bodies.begin());
        std::copy(middle, places_.end(), graph_.targets.begin());
    }

 private:
    struct Edge {
        const BodySighting* sighting;
        std::size_t target;  ///< as a vertex
        std::vector<Candidate> candidates;

        [[nodiscard]] std::size_t body() const { return sighting->body; }
        [[nodiscard]] bool At(std::size_t vertex) const {
            return vertex == body() || vertex == target;
        }
        [[nodiscard]] std::size_t Other(std::size_t vertex) const {
            return vertex == body() ? target : body();
        }
        /// How much better the best candidate is than the other.
        [[nodiscard]] double Certainty() const {
            if (candidates.empty()) return 0;
            return candidates.size() < 2
                       ? 1e9
                       : (candidates[1].squared_px + 1) / (candidates[0].squared_px + 1);
        }
    };

    /// The most certain sighting between a vertex with and one without a place, again and again.
    void GrowAll() {
        while (true) {
            const Edge* best = nullptr;
            for (const Edge& edge : edges_) {
                if (places_[edge.body()].has_value() == places_[edge.target].has_value()) continue;
                if (edge.candidates.empty()) continue;
                if (best == nullptr || edge.Certainty() > best->Certainty()) best = &edge;
            }
            if (best == nullptr) return;
            const std::size_t vertex = places_[best->body()] ? best->target : best->body();
            places_[vertex] = BestPlace(vertex);
        }
    }

    /// Once more for each vertex that was not known, now that its neighbours have places.
    void Repair() {
        const std::size_t bodies = graph_.bodies.size();
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const bool known =
                (i < bodies ? graph_.bodies[i] : graph_.targets[i - bodies]).has_value();
            if (known || !places_[i]) continue;
            const auto other = BestPlace(i);
            constexpr double kClearly = 0.9;
            if (other && Misfit(i, *other) < kClearly * Misfit(i, *places_[i])) places_[i] = other;
        }
    }

    std::optional<Isometry3d> BestPlace(std::size_t vertex) {
        std::optional<Isometry3d> best;
        double least = std::numeric_limits<double>::infinity();
        for (const Edge& edge : edges_) {
            if (!edge.At(vertex) || !places_[edge.Other(vertex)]) continue;
            for (const Candidate& candidate : edge.candidates) {
                const Isometry3d T_body_board =
                    edge.sighting->T_body_camera * candidate.T_camera_board;
                const Isometry3d& other = *places_[edge.Other(vertex)];
                const Isometry3d place =
                    other * (vertex == edge.body() ? T_body_board.inverse() : T_body_board);
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
            if (!edge.At(vertex) || !places_[edge.Other(vertex)]) continue;
            const Isometry3d& other = *places_[edge.Other(vertex)];
            const BodySighting& seen = *edge.sighting;
            const Isometry3d T_body_board =
                vertex == edge.body() ? place.inverse() * other : other.inverse() * place;
            const double most = kWrong_px * kWrong_px * static_cast<double>(seen.corners.size());
            sum += std::min(
                most, SquaredErrors(seen.model, seen.board_m,
                                    seen.T_body_camera.inverse() * T_body_board, seen.corners));
        }
        return sum;
    }

    PoseGraph& graph_;
    PoseGraph::Places places_;
    std::vector<Edge> edges_;
};

}  // namespace

void GrowPlaces(PoseGraph& graph) {
    Growth(graph).Run();
}

}  // namespace hitchview::calib
