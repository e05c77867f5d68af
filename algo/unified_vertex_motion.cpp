#include "algo/unified_vertex_motion.hpp"

#include <algorithm>
#include <cmath>

#include "algo/feature_mask.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;

/// The per-vertex offset: share kept per frame, and its bound (shake is above 1 Hz, the road
/// below).
constexpr float kResidualKept = 0.80F;
constexpr float kResidualBound_px = 2.0F;
/// Offset kept per frame while the motion is unknown.
constexpr double kDecay = 0.9;
/// A searched overlap is tried this often; a descriptor match costs more than a guided one.
constexpr int kAcquireEvery = 6;
constexpr int kFewestCandidates = 12;
constexpr int kLockedInliers = 12;
constexpr int kCoastFrames = 60;

}  // namespace

/// What one frame set told, kept until it is emitted.
struct UnifiedVertexMotion::Record {
    PerUnit<IntraMotion> intra;
    PerOverlap<InterFeatures> inter;
    Matrix3d M_tractor_trailer = Matrix3d::Identity();
    bool placed = false;
    PerOverlap<SeamState> seams{{SeamState::kNoOverlap, SeamState::kNoOverlap}};
    PerOverlap<int> matches;
    PerOverlap<int> candidates;
    PerUnit<int> features;
    std::optional<Articulation> articulation;
};

/// Expects a feature where the placement and the stitching field of the frame emitted last put it.
class UnifiedVertexMotion::Guidance final : public Expectation {
 public:
    Guidance(const UnifiedVertexMotion& owner, Overlap overlap, int& candidates)
        : owner_(owner), overlap_(overlap), candidates_(candidates) {
        const Matrix3d M_canvas_tractor =
            owner.layout_.M_canvas_tractor * owner.stabilizer_[Unit::kTractor][0];
        M_canvas_view_[Unit::kTractor] = M_canvas_tractor;
        M_canvas_view_[Unit::kTrailer] = M_canvas_tractor * owner.placement_->M_tractor_trailer();
        if (owner.hitch_known_) {  // the field starts from the smoothed placement
            const Matrix3d smoothed = owner.hitch_pose_[0] * owner.raw_hitch_pose_.inverse();
            M_canvas_view_[Unit::kTrailer] = owner.layout_.M_canvas_tractor * smoothed *
                                             owner.layout_.M_canvas_tractor.inverse() *
                                             M_canvas_view_[Unit::kTrailer];
        }
    }

    bool Expect(Unit unit, const Vector2f& pixel, Vector2f& other) const override {
        const Vector2d px = owner_.analysis_[unit]->view().ToView(pixel);
        const Vector3d ray = owner_.view(unit).Ray(px);
        const Matrix3d& M_canvas_unit = M_canvas_view_[unit];
        const Matrix3d& M_canvas_other = M_canvas_view_[Other(unit)];
        const Vector2d canvas_px = owner_.canvas_.Pixel(M_canvas_unit * ray);
        if (!InOverlap(canvas_px)) return false;
        const Vector2d e =
            Sample(owner_.stitching_.mesh(), owner_.stitching_.discrepancy(), canvas_px);
        const Vector2d there =
            unit == Unit::kTractor ? Vector2d(canvas_px + e) : Vector2d(canvas_px - e);
        const Unit opposite = Other(unit);
        const Vector2d expected =
            owner_.view(opposite).Pixel(M_canvas_other.inverse() * owner_.canvas_.Ray(there));
        other = owner_.analysis_[opposite]->view().ToAnalysis(expected);
        if (!Allows(owner_.analysis_[opposite]->view().mask(), other)) return false;
        ++candidates_;
        return true;
    }

 private:
    bool InOverlap(const Vector2d& canvas_px) const {
        if (!owner_.canvas_.IsRing()) return overlap_ == Overlap::kRight;
        return (canvas_px.x() < owner_.canvas_.Centre().x()) == (overlap_ == Overlap::kLeft);
    }

    const UnifiedVertexMotion& owner_;
    Overlap overlap_;
    int& candidates_;
    PerUnit<Matrix3d> M_canvas_view_;
};

UnifiedVertexMotion::UnifiedVertexMotion(const Projection& canvas,
                                         const PerUnit<std::optional<UnitGeometry>>& geometry,
                                         const UnifiedVertexMotionOptions& options)
    : canvas_(canvas),
      tractor_view_(geometry[Unit::kTractor]->view()),
      options_(options),
      stitching_(canvas, StitchingOptions(canvas, options.kappa)),
      records_(std::make_unique<std::array<Record, kRecords>>()) {
    if (geometry[Unit::kTrailer]) trailer_view_ = geometry[Unit::kTrailer]->view();
    for (const Unit unit : kUnits) {
        if (!geometry[unit]) continue;
        analysis_[unit] =
            std::make_unique<UnitAnalysis>(*geometry[unit], AnalysisOptions(view(unit)));
        smoother_[unit] = std::make_unique<PathSmoother>(StabilizerOptions(view(unit), options));
    }
    if (has_trailer()) {
        const SemiSurroundView& a = analysis_[Unit::kTractor]->view();
        const SemiSurroundView& b = analysis_[Unit::kTrailer]->view();
        matcher_ = std::make_unique<ClassicalMatcher>(std::max(a.width_px(), b.width_px()),
                                                      std::max(a.height_px(), b.height_px()),
                                                      ClassicalMatcherOptions{});
        placement_ = std::make_unique<TrailerPlacement>(tractor_view_, *trailer_view_,
                                                        PlacementOptions(canvas, a.scale()));
        hitch_smoother_ = std::make_unique<PathSmoother>(HitchSmootherOptions(tractor_view_));
        if (canvas.IsRing()) {
            articulation_ = std::make_unique<ArticulationEstimator>(
                *geometry[Unit::kTractor], *geometry[Unit::kTrailer], ArticulationOptions{});
        }
    }
    LayOut();
    Reset();
}

UnifiedVertexMotion::~UnifiedVertexMotion() = default;

UnifiedVertexMotion::Record& UnifiedVertexMotion::At(std::int64_t index) {
    return (*records_)[static_cast<std::size_t>(index % kRecords)];
}
const UnifiedVertexMotion::Record& UnifiedVertexMotion::At(std::int64_t index) const {
    return (*records_)[static_cast<std::size_t>(index % kRecords)];
}

void UnifiedVertexMotion::Reset() {
    analysed_ = emitted_ = 0;
    for (const Unit unit : kUnits) {
        stabilizer_[unit].fill(Matrix3d::Identity());
        view_offset_[unit].setZero();
        if (analysis_[unit]) analysis_[unit]->Reset();
        if (smoother_[unit]) smoother_[unit]->Reset();
    }
    if (hitch_smoother_) hitch_smoother_->Reset();
    if (articulation_) articulation_->Reset();
    hitch_known_ = false;
    stitching_.Reset();
    for (const Overlap overlap : kOverlaps) frames_unmatched_[overlap] = kCoastFrames;
}

void UnifiedVertexMotion::LayOut() {
    const Matrix3d* matched =
        has_trailer() && placement_->acquired() ? &placement_->M_tractor_trailer() : nullptr;
    layout_ = LayOutCanvas(canvas_, tractor_view_, trailer_view_, matched, options_);
}

bool UnifiedVertexMotion::Prime(const RigFrames& frames, TaskRunner& runner) {
    if (!has_trailer() || !options_.stitch) return true;
    if (canvas_.IsRing()) placement_->Start(Matrix3d::Identity());
    Record& record = At(0);
    Analyse(frames, runner, record);
    const bool found = AcquireTrailer(record);
    LayOut();
    return found;
}

const Composition* UnifiedVertexMotion::Step(const RigFrames& frames, TaskRunner& runner) {
    Record& record = At(analysed_);
    Analyse(frames, runner, record);
    if (has_trailer() && options_.stitch) MatchUnits(record);
    ++analysed_;
    if (analysed_ - emitted_ <= options_.lookahead_frames) return nullptr;
    return Emit(emitted_++);
}

const Composition* UnifiedVertexMotion::Flush() {
    return emitted_ < analysed_ ? Emit(emitted_++) : nullptr;
}

void UnifiedVertexMotion::Analyse(const RigFrames& frames, TaskRunner& runner, Record& record) {
    runner.Run(units(), [&](int i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i)];
        analysis_[unit]->Analyse(frames[unit], record.intra[unit]);
        record.features[unit] = record.intra[unit].inliers;
    });
}

void UnifiedVertexMotion::MatchUnits(Record& record) {
    placement_->Predict(record.intra);
    for (const Overlap overlap : kOverlaps) record.inter[overlap].clear();
    const bool lost = !placement_->acquired() || LongUnmatched();
    if (lost && analysed_ % kAcquireEvery == 0) {
        AcquireTrailer(record);
    } else if (placement_->acquired()) {
        Guide(record);
    }
    UpdateSeams(record);
    record.M_tractor_trailer = placement_->M_tractor_trailer();
    record.placed = placement_->acquired();
    if (articulation_) record.articulation = articulation_->Step(record.intra, record.inter);
}

/// No overlap has agreed with the placement for so long that it is searched from nothing.
bool UnifiedVertexMotion::LongUnmatched() const {
    return std::all_of(frames_unmatched_.of.begin(), frames_unmatched_.of.end(),
                       [](int frames) { return frames >= kCoastFrames; });
}

void UnifiedVertexMotion::Guide(Record& record) {
    const PerUnit<MatchView> views{
        {analysis_[Unit::kTractor]->match_view(), analysis_[Unit::kTrailer]->match_view()}};
    for (const Overlap overlap : kOverlaps) {
        record.candidates[overlap] = 0;
        matcher_->Guide(views, Guidance{*this, overlap, record.candidates[overlap]}, view_pairs_);
        for (const ViewPair& pair : view_pairs_) {
            record.inter[overlap].push_back(
                {analysis_[Unit::kTractor]->view().ToView(pair.tractor_px),
                 analysis_[Unit::kTrailer]->view().ToView(pair.trailer_px)});
        }
    }
    placement_->Correct(record.inter);
}

bool UnifiedVertexMotion::AcquireTrailer(Record& record) {
    const PerUnit<MatchView> views{
        {analysis_[Unit::kTractor]->match_view(), analysis_[Unit::kTrailer]->match_view()}};
    const SemiSurroundView& tractor = analysis_[Unit::kTractor]->view();
    const SemiSurroundView& trailer = analysis_[Unit::kTrailer]->view();
    for (const Overlap overlap : kOverlaps) {
        record.inter[overlap].clear();
        PerUnit<cv::Rect> regions{{cv::Rect(0, 0, tractor.width_px(), tractor.height_px()),
                                   cv::Rect(0, 0, trailer.width_px(), trailer.height_px())}};
        if (canvas_.IsRing()) {
            // Left of the vehicle lies left of the middle in the tractor's view, and right of it in
            // the trailer's, which looks back.
            const bool left = overlap == Overlap::kLeft;
            for (const Unit unit : kUnits) {
                cv::Rect& r = regions[unit];
                r.width /= 2;
                if (left == (unit == Unit::kTrailer)) r.x = r.width;
            }
        } else if (overlap == Overlap::kLeft) {
            continue;
        }
        matcher_->Acquire(views, regions, view_pairs_);
        for (const ViewPair& pair : view_pairs_) {
            record.inter[overlap].push_back(
                {tractor.ToView(pair.tractor_px), trailer.ToView(pair.trailer_px)});
        }
    }
    return placement_->Acquire(record.inter);
}

void UnifiedVertexMotion::UpdateSeams(Record& record) {
    for (const Overlap overlap : kOverlaps) {
        const int inliers = placement_->inliers()[overlap];
        record.matches[overlap] = inliers;
        int& unmatched = frames_unmatched_[overlap];
        unmatched = inliers >= kLockedInliers ? 0 : std::min(unmatched + 1, kCoastFrames);
        if (unmatched == 0) {
            record.seams[overlap] = SeamState::kLocked;
        } else if (!placement_->acquired() || record.candidates[overlap] < kFewestCandidates) {
            record.seams[overlap] = SeamState::kNoOverlap;
        } else {
            record.seams[overlap] =
                unmatched < kCoastFrames ? SeamState::kCoast : SeamState::kReacquire;
        }
    }
}

const Composition* UnifiedVertexMotion::Emit(std::int64_t index) {
    const Record& record = At(index);
    for (int i = 0; i < units(); ++i) {
        const Unit unit = kUnits[static_cast<std::size_t>(i)];
        Stabilise(index, unit);
        UpdateViewOffset(record, unit);
    }
    if (has_trailer()) PlaceTrailer(record);
    Compose(record);
    if (has_trailer() && record.placed) UpdateStitching(record);
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

void UnifiedVertexMotion::UpdateViewOffset(const Record& record, Unit unit) {
    if (!options_.stabilize) return;
    VertexField& offset = view_offset_[unit];
    offset = (kResidualKept * (offset - record.intra[unit].residual))
                 .cwiseMax(-kResidualBound_px)
                 .cwiseMin(kResidualBound_px);
}

/// Placement of the stabilised trailer view on the stabilised tractor view. It holds no shake, only
/// the hitch and the noise of matching, and is smoothed once more: what that leaves is taken up by
/// the stitching field, inside the overlap alone.
void UnifiedVertexMotion::PlaceTrailer(const Record& record) {
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

void UnifiedVertexMotion::Compose(const Record& record) {
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

Vector2d UnifiedVertexMotion::OnCanvas(Unit unit, const Vector2d& view_px) const {
    const Mesh mesh(view(unit));
    const Vector2d moved = view_px + Sample(mesh, view_offset_[unit], view_px);
    return canvas_.Pixel(composition_.M_canvas_view[unit] * view(unit).Ray(moved));
}

void UnifiedVertexMotion::UpdateStitching(const Record& record) {
    for (const Overlap overlap : kOverlaps) {
        canvas_pairs_.clear();
        for (const InterFeature& f : record.inter[overlap]) {
            const CanvasPair pair{OnCanvas(Unit::kTractor, f.tractor_px),
                                  OnCanvas(Unit::kTrailer, f.trailer_px)};
            if (canvas_.Difference(pair.tractor_px, pair.trailer_px).norm() < kMaxParallax_px) {
                canvas_pairs_.push_back(pair);
            }
        }
        stitching_.Update(canvas_pairs_);
    }
    stitching_.Extend();
}

}  // namespace hitchview::algo
