#include "algo/offline_unified_vertex_motion.hpp"

#include "algo/field_extension.hpp"
#include "algo/fold_guard.hpp"
#include "algo/overlap_discrepancy.hpp"
#include "algo/placement_path.hpp"
#include "algo/warp_factor.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr Index kAxes = 2 * Mesh::kVertices;
/// Smoothness in time of how far a vertex is supported by matches.
constexpr ProfileSmoothingOptions kSupportSmoothing{.lambda = 0.5};
/// Inliers at which a placement is half believed, and the belief in one that was predicted alone.
constexpr double kHalfBelieved = 12;
constexpr double kPredictedBelief = 0.02;

/// A row of profiles holds a field in its own order: x and y of each vertex in turn.
VertexField ToField(const Profiles& profiles, std::size_t frame) {
    const Eigen::VectorXf row = profiles.row(static_cast<Index>(frame)).transpose().cast<float>();
    return Eigen::Map<const VertexField>(row.data());
}

void SetRow(Profiles& profiles, std::size_t frame, const VertexField& field) {
    profiles.row(static_cast<Index>(frame)) =
        Eigen::Map<const Eigen::RowVectorXf>(field.data(), kAxes).cast<double>();
}

/// What a frame's intra motion does to the vertices of the view.
VertexField VertexMotions(const Projection& view, const IntraMotion& motion) {
    const Mesh mesh(view);
    VertexField field = motion.residual;
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const Vector2d v = mesh.Vertex(row, col);
            const Vector2d moved = view.Pixel(motion.M_late_early * view.Ray(v));
            field.col(Mesh::Index(row, col)) += view.Difference(moved, v).cast<float>();
        }
    }
    return field;
}

double Belief(const RigMotion& motion) {
    if (!motion.placed) return 0;
    const double inliers = motion.matches[Overlap::kLeft] + motion.matches[Overlap::kRight];
    return std::max(kPredictedBelief, inliers / (inliers + kHalfBelieved));
}

}  // namespace

OfflineUnifiedVertexMotion::OfflineUnifiedVertexMotion(
    const Projection& canvas, const PerUnit<std::optional<UnitGeometry>>& geometry,
    const OfflineOptions& options)
    : canvas_(canvas),
      tractor_view_(geometry[Unit::kTractor]->view()),
      options_(options),
      estimator_(canvas, geometry, options.motion) {
    if (geometry[Unit::kTrailer]) trailer_view_ = geometry[Unit::kTrailer]->view();
    layout_ = LayOutCanvas(canvas_, tractor_view_, trailer_view_, nullptr, options_.motion);
}

bool OfflineUnifiedVertexMotion::Prime(const RigFrames& frames, TaskRunner& runner) {
    const bool found = estimator_.Prime(frames, runner);
    layout_ = LayOutCanvas(canvas_, tractor_view_, trailer_view_, estimator_.M_tractor_trailer(),
                           options_.motion);
    return found;
}

void OfflineUnifiedVertexMotion::Learn(const RigFrames& frames, TaskRunner& runner) {
    if (learnt_.empty()) estimator_.Reset();
    MatchGuess guess;
    guess.M_canvas_tractor = layout_.M_canvas_tractor;
    estimator_.Estimate(frames, guess, runner, learnt_.emplace_back());
}

const Composition* OfflineUnifiedVertexMotion::Step(const RigFrames&, TaskRunner&) {
    return shown_ < compositions_.size() ? &compositions_[shown_++] : nullptr;
}

void OfflineUnifiedVertexMotion::Solve() {
    Describe();
    if (literal()) {
        SolveLiterally();
    } else {
        SolveCorrected();
    }
}

void OfflineUnifiedVertexMotion::SolveCorrected() {
    for (int i = 0; i < units(); ++i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i)];
        const Profiles T = Trajectories(unit);
        Warp(unit, SmoothProfiles(T, options_.stages.smoothing) - T);
    }
    Place();
    Stitch();
}

void OfflineUnifiedVertexMotion::SolveLiterally() {
    Place();
    Stitch();
    PerUnit<OverlapProfiles> profiles;
    for (const Unit unit : kUnits) profiles[unit] = {Trajectories(unit), StitchingProfiles(unit)};
    for (Composition& c : compositions_) c.discrepancy.setZero();
    const auto found = SolvePaperStages(profiles, {}, Coupling::kLiteral, options_.stages);
    for (const Unit unit : kUnits) Warp(unit, found[unit].Warp(profiles[unit].T));
}

void OfflineUnifiedVertexMotion::Describe() {
    compositions_.assign(learnt_.size(), Composition{});
    for (std::size_t i = 0; i < learnt_.size(); ++i) {
        Composition& c = compositions_[i];
        c.kappa = options_.motion.kappa;
        c.seams = learnt_[i].seams;
        c.matches = learnt_[i].matches;
        c.features = learnt_[i].features;
        c.articulation = learnt_[i].articulation;
    }
}

Profiles OfflineUnifiedVertexMotion::Trajectories(Unit unit) const {
    Profiles motion = Profiles::Zero(static_cast<Index>(learnt_.size()), kAxes);
    if (!options_.motion.stabilize) return motion;
    for (std::size_t i = 1; i < learnt_.size(); ++i) {
        SetRow(motion, i, VertexMotions(view(unit), learnt_[i].intra[unit]));
    }
    return AccumulateMotion(motion);
}

/// Puts a warp of the unit's view before what its pose is so far.
void OfflineUnifiedVertexMotion::Warp(Unit unit, const Profiles& warp) {
    for (std::size_t i = 0; i < compositions_.size(); ++i) {
        Composition& c = compositions_[i];
        const FactoredWarp factored = FactorWarp(view(unit), ToField(warp, i));
        c.M_canvas_view[unit] = c.M_canvas_view[unit] * factored.pose;
        c.view_offset[unit] = factored.rest;
        GuardFolds(Mesh(view(unit)), kMaxStretch, c.view_offset[unit]);
        c.stabilization[unit] = ToOffset(view(unit), factored.pose);
    }
}

/// Puts both views on the canvas. Literally the trailer goes where it was matched; otherwise its
/// stabilised view goes to where it lies on the tractor's stabilised view, without the noise.
void OfflineUnifiedVertexMotion::Place() {
    std::vector<PlacementSample> samples;
    for (std::size_t i = 0; i < learnt_.size(); ++i) {
        const auto& M = compositions_[i].M_canvas_view;
        samples.push_back(
            {M[Unit::kTractor] * learnt_[i].M_tractor_trailer * M[Unit::kTrailer].inverse(),
             Belief(learnt_[i])});
    }
    const auto placements =
        SmoothPlacements(tractor_view_, samples, literal() ? 0 : options_.placement_mu,
                         options_.stages.smoothing.radius_frames);
    for (std::size_t i = 0; i < compositions_.size(); ++i) {
        auto& M = compositions_[i].M_canvas_view;
        M[Unit::kTractor] = layout_.M_canvas_tractor * M[Unit::kTractor];
        const Matrix3d M_canvas_trailer = placements.empty()
                                              ? layout_.M_canvas_trailer
                                              : Matrix3d(layout_.M_canvas_tractor * placements[i]);
        M[Unit::kTrailer] = M_canvas_trailer * M[Unit::kTrailer];
    }
}

CanvasPairs OfflineUnifiedVertexMotion::PairsOnCanvas(std::size_t frame, Overlap overlap) const {
    const auto on_canvas = [&](Unit unit, const Vector2d& view_px) {
        return ToCanvas(canvas_, view(unit), compositions_[frame], unit, view(unit).Ray(view_px));
    };
    CanvasPairs pairs;
    const RigMotion& motion = learnt_[frame];
    for (const InterFeatures* features : {&motion.inter[overlap], &motion.dense[overlap]}) {
        for (const InterFeature& f : *features) {
            const CanvasPair pair{on_canvas(Unit::kTractor, f.tractor_px),
                                  on_canvas(Unit::kTrailer, f.trailer_px)};
            const Vector2d apart = canvas_.Difference(pair.tractor_px, pair.trailer_px);
            if (apart.norm() < MaxParallax_px(canvas_)) pairs.push_back(pair);
        }
    }
    return pairs;
}

/// Of every frame: what is left between the two views where they are now.
void OfflineUnifiedVertexMotion::Measure(Profiles& discrepancy, Profiles& confidence) const {
    OverlapDiscrepancy meter(canvas_, DiscrepancyOptions(canvas_, options_.motion.kappa));
    for (std::size_t i = 0; i < learnt_.size(); ++i) {
        MeasuredDiscrepancy measured;
        for (const Overlap overlap : kOverlaps) meter.Measure(PairsOnCanvas(i, overlap), measured);
        SetRow(discrepancy, i, measured.field);
        SetRow(confidence, i, measured.confidence.replicate<2, 1>());
    }
}

void OfflineUnifiedVertexMotion::Stitch() {
    if (!trailer_view_ || !options_.motion.stitch) return;
    const auto frames = static_cast<Index>(learnt_.size());
    Profiles discrepancy(frames, kAxes);
    Profiles confidence(frames, kAxes);
    Measure(discrepancy, confidence);
    if (!literal()) {
        discrepancy = SmoothByConfidence(discrepancy, confidence, options_.stages.mu,
                                         options_.stages.smoothing.radius_frames);
        confidence = SmoothProfiles(confidence, kSupportSmoothing);
    }
    const Mesh mesh(canvas_);
    for (std::size_t i = 0; i < compositions_.size(); ++i) {
        VertexField& field = compositions_[i].discrepancy;
        field = ExtendField(mesh, ToField(discrepancy, i), ToField(confidence, i).row(0));
        GuardFolds(mesh, kMaxStretch, field);
    }
}

/// V at the vertices of the unit's view: from where the placement shows them to where both views
/// meet.
Profiles OfflineUnifiedVertexMotion::StitchingProfiles(Unit unit) const {
    const Mesh mesh(view(unit));
    Profiles V(static_cast<Index>(learnt_.size()), kAxes);
    VertexField field;
    for (std::size_t i = 0; i < compositions_.size(); ++i) {
        const Matrix3d M_view_canvas = compositions_[i].M_canvas_view[unit].inverse();
        for (int row = 0; row < Mesh::kVertexRows; ++row) {
            for (int col = 0; col < Mesh::kVertexCols; ++col) {
                const Vector2d v = mesh.Vertex(row, col);
                const Vector2d met =
                    ToCanvas(canvas_, view(unit), compositions_[i], unit, view(unit).Ray(v));
                const Vector2d there = view(unit).Pixel(M_view_canvas * canvas_.Ray(met));
                field.col(Mesh::Index(row, col)) = view(unit).Difference(there, v).cast<float>();
            }
        }
        SetRow(V, i, field);
    }
    return V;
}

}  // namespace hitchview::algo
