#include "algo/unified_vertex_motion.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;

/// Share of the per-vertex offset that is kept per frame: shake is above 1 Hz, the road below.
constexpr float kResidualKept = 0.80F;
/// Offset kept per frame while the motion is unknown.
constexpr double kDecay = 0.9;

}  // namespace

UnifiedVertexMotion::UnifiedVertexMotion(const Projection& canvas,
                                         const PerUnit<std::optional<UnitGeometry>>& geometry,
                                         const UnifiedVertexMotionOptions& options)
    : canvas_(canvas),
      tractor_view_(geometry[Unit::kTractor]->view()),
      view_mesh_{{Mesh(tractor_view_), Mesh(tractor_view_)}},
      options_(options),
      estimator_(canvas, geometry, options),
      max_parallax_px_(MaxParallax_px(canvas)),
      max_mesh_parallax_px_(MaxMeshParallax_px(canvas)),
      stitching_(canvas, StitchingOptions(canvas, options.kappa)),
      records_(std::make_unique<std::array<RigMotion, kRecords>>()) {
    if (geometry[Unit::kTrailer]) {
        trailer_view_ = geometry[Unit::kTrailer]->view();
        view_mesh_[Unit::kTrailer] = Mesh(*trailer_view_);
    }
    for (const Unit unit : kUnits) {
        if (!geometry[unit]) continue;
        smoother_[unit] =
            std::make_unique<UnitSmoother>(MakeUnitSmoother(canvas, view(unit), options));
    }
    if (has_trailer()) {
        if (canvas.IsRing()) {
            parallax_ = std::make_unique<std::array<RigParallax, kRecords>>();
            detail_ = std::make_unique<DetailField>(canvas, DetailOptions(canvas, options.kappa));
            for (const Unit unit : kUnits)
                on_canvas_[unit] = std::make_unique<PictureMap>(view(unit), canvas);
        }
        hitch_smoother_ = std::make_unique<PathSmoother>(HitchSmootherOptions(tractor_view_));
    }
    LayOut();
    Reset();
}

UnifiedVertexMotion::~UnifiedVertexMotion() = default;

RigMotion& UnifiedVertexMotion::At(std::int64_t index) {
    return (*records_)[static_cast<std::size_t>(index % kRecords)];
}
RigParallax* UnifiedVertexMotion::ParallaxAt(std::int64_t index) {
    return parallax_ ? &(*parallax_)[static_cast<std::size_t>(index % kRecords)] : nullptr;
}
const RigMotion& UnifiedVertexMotion::At(std::int64_t index) const {
    return (*records_)[static_cast<std::size_t>(index % kRecords)];
}

void UnifiedVertexMotion::Reset() {
    analysed_ = emitted_ = 0;
    estimator_.Reset();
    for (const Unit unit : kUnits) {
        stabilizer_[unit].fill(Matrix3d::Identity());
        view_offset_[unit].setZero();
        if (smoother_[unit]) smoother_[unit]->Reset();
    }
    if (hitch_smoother_) hitch_smoother_->Reset();
    hitch_known_ = false;
    stitching_.Reset();
    if (detail_) {
        detail_->Reset();
        ShowNoDetail();
    }
}

void UnifiedVertexMotion::LayOut() {
    layout_ = LayOutCanvas(canvas_, tractor_view_, trailer_view_, estimator_.M_tractor_trailer(),
                           options_);
}

bool UnifiedVertexMotion::Prime(const RigFrames& frames, TaskRunner& runner) {
    const bool found = estimator_.Prime(frames, runner);
    LayOut();
    return found;
}

const Composition* UnifiedVertexMotion::Step(const RigFrames& frames, TaskRunner& runner) {
    UpdateGuess();
    estimator_.Estimate(frames, guess_, runner, At(analysed_), ParallaxAt(analysed_));
    guess_.match = true;
    ++analysed_;
    if (analysed_ - emitted_ <= options_.lookahead_frames) return nullptr;
    return Emit(emitted_++, runner);
}

bool UnifiedVertexMotion::LightenNextStep() {
    const bool matched = analysed_ > 0 && At(analysed_ - 1).matched;
    guess_.match = !(has_trailer() && matched);
    return !guess_.match;
}

/// A feature is expected where the frame emitted last shows it.
void UnifiedVertexMotion::UpdateGuess() {
    guess_.M_canvas_tractor = layout_.M_canvas_tractor * stabilizer_[Unit::kTractor][0];
    guess_.M_shown_placed.setIdentity();
    if (hitch_known_) {  // the field starts from the smoothed placement
        guess_.M_shown_placed = layout_.M_canvas_tractor * hitch_pose_[0] *
                                raw_hitch_pose_.inverse() * layout_.M_canvas_tractor.inverse();
    }
    guess_.discrepancy = stitching_.discrepancy();
}

const Composition* UnifiedVertexMotion::Flush() {
    SerialRunner runner;
    return emitted_ < analysed_ ? Emit(emitted_++, runner) : nullptr;
}

const Composition* UnifiedVertexMotion::Emit(std::int64_t index, TaskRunner& runner) {
    const RigMotion& record = At(index);
    for (int i = 0; i < units(); ++i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i)];
        Stabilise(index, unit);
        UpdateViewOffset(record, unit);
    }
    if (has_trailer()) PlaceTrailer(record);
    const Matrix3d M_canvas_early = composition_.M_canvas_view[Unit::kTractor];
    Compose(record);
    if (has_trailer() && record.placed) {
        UpdateStitching(record, M_canvas_early);
        if (detail_ && record.matched) UpdateDetail(*ParallaxAt(index), runner);
    }
    composition_.discrepancy = stitching_.discrepancy();
    return &composition_;
}

PathSmoother::Window UnifiedVertexMotion::Window(std::int64_t index, Unit unit) const {
    const Projection& picture = view(unit);
    const Matrix3d G = At(index).intra[unit].M_late_early;
    const Matrix3d G_early =
        index > 0 ? At(index - 1).intra[unit].M_late_early : Matrix3d(Matrix3d::Identity());
    PathSmoother::Window window;
    window.early_output = ToOffset(picture, stabilizer_[unit][0] * G.inverse()).value;
    window.earlier_output = ToOffset(picture, stabilizer_[unit][1] * (G * G_early).inverse()).value;
    window.motion = ToOffset(picture, G).value;
    Matrix3d ahead = Matrix3d::Identity();
    for (int j = 1; j <= options_.lookahead_frames; ++j) {
        // At the end of a recording the view is taken to stand still.
        if (index + j < analysed_) ahead = At(index + j).intra[unit].M_late_early * ahead;
        window.ahead[static_cast<std::size_t>(j - 1)] = ToOffset(picture, ahead).value;
    }
    return window;
}

void UnifiedVertexMotion::Stabilise(std::int64_t index, Unit unit) {
    PoseOffset offset;
    if (options_.stabilize) {
        const PathSmoother::Window window = Window(index, unit);
        offset.value = At(index).intra[unit].known || index == 0
                           ? smoother_[unit]->Next(window)
                           : Vector3d(kDecay * window.early_output);
    }
    stabilizer_[unit][1] = stabilizer_[unit][0];
    stabilizer_[unit][0] = ToPose(view(unit), offset);
    composition_.stabilization[unit] = offset;
}

void UnifiedVertexMotion::UpdateViewOffset(const RigMotion& record, Unit unit) {
    if (!options_.stabilize) return;
    VertexField& offset = view_offset_[unit];
    const auto most_px = static_cast<float>(MostResidual_px(view(unit)));
    offset = (kResidualKept * (offset - record.intra[unit].residual))
                 .cwiseMax(-most_px)
                 .cwiseMin(most_px);
}

/// Placement of the stabilised trailer view on the stabilised tractor view. It holds no shake, only
/// the hitch and the noise of matching, and is smoothed once more: what that leaves is taken up by
/// the stitching field, inside the overlap alone.
void UnifiedVertexMotion::PlaceTrailer(const RigMotion& record) {
    if (!record.placed) {
        hitch_known_ = false;
        return;
    }
    Matrix3d raw = stabilizer_[Unit::kTractor][0] * record.M_tractor_trailer *
                   stabilizer_[Unit::kTrailer][0].inverse();
    const double scale = ScaleOf(tractor_view_, raw);
    if (!hitch_known_) {
        hitch_scale_ = scale;
        raw_hitch_pose_ = raw;
        hitch_pose_.fill(raw);
        hitch_smoother_->Reset();
        hitch_known_ = true;
    }
    constexpr double kScaleGain = 0.05;
    hitch_scale_ += kScaleGain * (scale - hitch_scale_);
    if (!canvas_.IsRing()) raw = ZoomAbout(tractor_view_.Centre(), hitch_scale_ / scale) * raw;
    PathSmoother::Window window;
    window.early_output = ToOffset(tractor_view_, hitch_pose_[0] * raw.inverse()).value;
    window.earlier_output = ToOffset(tractor_view_, hitch_pose_[1] * raw.inverse()).value;
    window.motion = ToOffset(tractor_view_, raw * raw_hitch_pose_.inverse()).value;
    const PoseOffset offset{hitch_smoother_->Next(window)};
    raw_hitch_pose_ = raw;
    hitch_pose_[1] = hitch_pose_[0];
    hitch_pose_[0] = ToPose(tractor_view_, offset) * raw;
}

void UnifiedVertexMotion::Compose(const RigMotion& record) {
    Composition& c = composition_;
    c.kappa = options_.kappa;
    c.M_canvas_view[Unit::kTractor] = layout_.M_canvas_tractor * stabilizer_[Unit::kTractor][0];
    if (has_trailer()) {
        c.M_canvas_view[Unit::kTrailer] =
            (record.placed ? Matrix3d(layout_.M_canvas_tractor * hitch_pose_[0])
                           : layout_.M_canvas_trailer) *
            stabilizer_[Unit::kTrailer][0];
    }
    c.view_offset = view_offset_;
    c.seams = record.seams;
    c.matches = record.matches;
    c.features = record.features;
    c.articulation = record.articulation;
}

Vector2d UnifiedVertexMotion::Moved(Unit unit, const Vector2d& view_px) const {
    return view_px + Sample(view_mesh_[unit], view_offset_[unit], view_px);
}

Vector2d UnifiedVertexMotion::OnCanvas(Unit unit, const Vector2d& view_px) const {
    return canvas_.Pixel(composition_.M_canvas_view[unit] * view(unit).Ray(Moved(unit, view_px)));
}

void UnifiedVertexMotion::TakePairs(const InterFeatures& features) {
    for (const InterFeature& f : features) {
        const CanvasPair pair{OnCanvas(Unit::kTractor, f.tractor_px),
                              OnCanvas(Unit::kTrailer, f.trailer_px)};
        if (canvas_.Difference(pair.tractor_px, pair.trailer_px).norm() < max_mesh_parallax_px_) {
            canvas_pairs_.push_back(pair);
        }
    }
}

void UnifiedVertexMotion::UpdateStitching(const RigMotion& record, const Matrix3d& M_canvas_early) {
    const Matrix3d M_canvas_late = composition_.M_canvas_view[Unit::kTractor];
    stitching_.Carry(M_canvas_early * record.intra[Unit::kTractor].M_late_early.inverse() *
                     M_canvas_late.inverse());
    for (const Overlap overlap : kOverlaps) {
        canvas_pairs_.clear();
        TakePairs(record.inter[overlap]);
        TakePairs(record.dense[overlap]);
        stitching_.Update(canvas_pairs_);
    }
    stitching_.Extend();
}

/// Takes the memory for it, too.
void UnifiedVertexMotion::ShowNoDetail() {
    composition_.detail = detail_->detail();
    composition_.detail.Clear();
    composition_.doubt_px = detail_->doubt_px();
    composition_.doubt_px.Clear();
}

void UnifiedVertexMotion::UpdateDetail(const RigParallax& parallax, TaskRunner& runner) {
    for (const Unit unit : kUnits)
        on_canvas_[unit]->Update(composition_.M_canvas_view[unit], runner);
    runner.Run(static_cast<int>(kOverlaps.size()), [&](int i) {
        const Overlap overlap = kOverlaps[static_cast<std::size_t>(i)];
        UpdateDetail(parallax[overlap], overlap);
    });
    composition_.detail = detail_->detail();
    composition_.doubt_px = detail_->doubt_px();
}

void UnifiedVertexMotion::UpdateDetail(const ParallaxSamples& samples, Overlap overlap) {
    detail_->Clear(overlap);
    for (const ParallaxSample& sample : samples) {
        const CanvasPair pair{
            on_canvas_[Unit::kTractor]->At(Moved(Unit::kTractor, sample.pair.tractor_px)),
            on_canvas_[Unit::kTrailer]->At(Moved(Unit::kTrailer, sample.pair.trailer_px))};
        if (canvas_.Difference(pair.tractor_px, pair.trailer_px).norm() < max_parallax_px_)
            detail_->Add(overlap, pair, sample.weight);
    }
    detail_->Fit(overlap, stitching_.discrepancy());
}

}  // namespace hitchview::algo
