#include "algo/unified_vertex_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;

/// Pairs farther from the rigid placement than this are another thing, not parallax; canvas px.
constexpr double kMaxParallax_px = 24;
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

double AnalysisScale(const Projection& view) {
    if (view.IsRing()) return std::min(1.0, 1024.0 / view.width_px);
    return view.width_px > 960 ? 0.5 : 1.0;
}

UnitAnalysisOptions AnalysisOptions(const Projection& view) {
    UnitAnalysisOptions options;
    options.scale = AnalysisScale(view);
    options.field.robust.max_sigma_px = 1.0 / options.scale;
    options.field.max_residual_px = 3.0 / options.scale;
    options.field.propagation = {.radius_px = {0.16 * view.width_px, 0.25 * view.height_px},
                                 .min_votes = 4,
                                 .shrink_votes = 6};
    if (view.IsRing()) options.field.propagation.radius_px.x() = 0.06 * view.width_px;
    return options;
}

StitchingMotionFieldOptions StitchingOptions(const Projection& canvas, double kappa) {
    StitchingMotionFieldOptions options;
    options.kappa = kappa;
    options.propagation = {.radius_px = {0.05 * canvas.width_px, 0.2 * canvas.height_px},
                           .min_votes = 3,
                           .shrink_votes = 3};
    options.max_discrepancy_px = kMaxParallax_px;
    // Round a vehicle near and far things mix in an overlap, and single measurements jump.
    if (canvas.IsRing()) options.gain = 0.3;
    return options;
}

/// Bounds of a unit's offset: shift in px of the view, turn in rad.
Vector3d Wall(const Projection& view, const UnifiedVertexMotionOptions& options) {
    constexpr double kDegree = std::numbers::pi / 180;
    // A ring has no border sideways: there the bound is the lag of the heading in a bend.
    if (view.IsRing()) return {8 * kDegree * view.focal_px, 3 * kDegree, 3 * kDegree};
    if (options.border == Border::kFree) return {0.28 * view.width_px, 0.28 * view.height_px, 0.06};
    const double margin = 0.5 * (1 - options.cropping);
    // The turn eats its share of the shift's margin: half the diagonal times the turn.
    const double turn = 0.25 * margin;
    return {margin * view.width_px - 0.5 * turn * view.height_px,
            margin * view.height_px - 0.5 * turn * view.width_px, turn};
}

PathSmootherOptions SmootherOptions(const Projection& view,
                                    const UnifiedVertexMotionOptions& options) {
    PathSmootherOptions smoother;
    smoother.lookahead_frames = options.lookahead_frames;
    smoother.wall = Wall(view, options);
    if (view.IsRing()) {  // steering is slow and a vehicle's shake fast: no need to hold back
                          // longer
        smoother.weakest_pull = 1e-3;
        smoother.strongest_pull = 0.1;
    }
    return smoother;
}

PathSmootherOptions HitchSmootherOptions(const Projection& view) {
    PathSmootherOptions smoother;
    smoother.weakest_pull = 0.03;
    smoother.strongest_pull = 3.0;
    smoother.wall = {8, view.IsRing() ? 0.02 : 8, view.IsRing() ? 0.02 : 0.03};
    return smoother;
}

Matrix3d Shift(const Vector2d& by) {
    Matrix3d m = Matrix3d::Identity();
    m.topRightCorner<2, 1>() = by;
    return m;
}

Matrix3d ZoomAbout(const Vector2d& centre, double zoom) {
    Matrix3d m = Matrix3d::Identity();
    m(0, 0) = m(1, 1) = zoom;
    m.topRightCorner<2, 1>() = (1 - zoom) * centre;
    return m;
}

Vector2d Size(const Projection& picture) {
    return {double(picture.width_px), double(picture.height_px)};
}

}  // namespace

Vector2d ToCanvas(const Projection& canvas, const Projection& view, const Composition& composition,
                  Unit unit, const Vector3d& view_ray) {
    const Vector2d view_px = view.Pixel(view_ray);
    const Vector2d moved = view_px + Sample(Mesh(view), composition.view_offset[unit], view_px);
    const Vector2d placed = canvas.Pixel(composition.M_canvas_view[unit] * view.Ray(moved));
    const double moves = unit == Unit::kTractor ? -composition.kappa : 1 - composition.kappa;
    const Mesh mesh(canvas);
    constexpr int kSteps = 6;  // fixed point of shown = placed - moves e(shown)
    Vector2d shown = placed;
    for (int i = 0; i < kSteps; ++i)
        shown = placed - moves * Sample(mesh, composition.discrepancy, shown);
    return shown;
}

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
};

/// Expects a feature where the placement and the stitching field of the frame emitted last put it.
class UnifiedVertexMotion::Guidance final : public Expectation {
 public:
    Guidance(const UnifiedVertexMotion& owner, Overlap overlap, int& candidates)
        : owner_(owner), overlap_(overlap), candidates_(candidates) {
        const Matrix3d M_canvas_tractor =
            owner.M_canvas_tractor_ * owner.stabilizer_[Unit::kTractor][0];
        M_canvas_view_[Unit::kTractor] = M_canvas_tractor;
        M_canvas_view_[Unit::kTrailer] = M_canvas_tractor * owner.placement_->M_tractor_trailer();
        if (owner.hitch_known_) {  // the field starts from the smoothed placement
            const Matrix3d smoothed = owner.hitch_pose_[0] * owner.raw_hitch_pose_.inverse();
            M_canvas_view_[Unit::kTrailer] = owner.M_canvas_tractor_ * smoothed *
                                             owner.M_canvas_tractor_.inverse() *
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
        if (!Visible(opposite, other)) return false;
        ++candidates_;
        return true;
    }

 private:
    bool InOverlap(const Vector2d& canvas_px) const {
        if (!owner_.canvas_.IsRing()) return overlap_ == Overlap::kRight;
        return (canvas_px.x() < owner_.canvas_.Centre().x()) == (overlap_ == Overlap::kLeft);
    }
    bool Visible(Unit unit, const Vector2f& pixel) const {
        const cv::Mat1b& mask = owner_.analysis_[unit]->view().mask();
        const auto x = static_cast<int>(std::lround(pixel.x()));
        const auto y = static_cast<int>(std::lround(pixel.y()));
        return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask(y, x) != 0;
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
        smoother_[unit] = std::make_unique<PathSmoother>(SmootherOptions(view(unit), options));
    }
    if (has_trailer()) {
        const SemiSurroundView& a = analysis_[Unit::kTractor]->view();
        const SemiSurroundView& b = analysis_[Unit::kTrailer]->view();
        matcher_ = std::make_unique<ClassicalMatcher>(std::max(a.width_px(), b.width_px()),
                                                      std::max(a.height_px(), b.height_px()),
                                                      ClassicalMatcherOptions{});
        TrailerPlacementOptions placement;
        if (canvas.IsRing()) placement.gain = 0.3;
        placement.robust.max_sigma_px /= a.scale();
        placement.acquire.max_sigma_px /= a.scale();
        placement_ = std::make_unique<TrailerPlacement>(tractor_view_, *trailer_view_, placement);
        hitch_smoother_ = std::make_unique<PathSmoother>(HitchSmootherOptions(tractor_view_));
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
    hitch_known_ = false;
    stitching_.Reset();
    for (const Overlap overlap : kOverlaps) frames_unmatched_[overlap] = kCoastFrames;
}

/// The canvas for the placement as it is known now. A ring lies in the tractor's frame.
void UnifiedVertexMotion::LayOut() {
    M_canvas_tractor_.setIdentity();
    M_loose_[Unit::kTractor] = M_loose_[Unit::kTrailer] = Matrix3d::Identity();
    if (canvas_.IsRing()) return;

    const Vector2d canvas = Size(canvas_);
    const Vector2d tractor = Size(tractor_view_);
    Vector2d low = Vector2d::Zero();
    Vector2d high = tractor;
    if (has_trailer() && placement_->acquired()) {
        const Vector2d size = Size(*trailer_view_);
        for (const Vector2d& corner :
             {Vector2d(0, 0), Vector2d(size.x(), 0), Vector2d(0, size.y()), size}) {
            const Vector2d p =
                (placement_->M_tractor_trailer() * corner.homogeneous()).hnormalized();
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    M_canvas_tractor_ = Shift(0.5 * (canvas - (low + high)));
    if (has_trailer() && !placement_->acquired()) {
        M_canvas_tractor_ = Shift({0, 0.5 * (canvas.y() - tractor.y())});
        const Vector2d trailer = Size(*trailer_view_);
        M_loose_[Unit::kTrailer] =
            Shift({canvas.x() - trailer.x(), 0.5 * (canvas.y() - trailer.y())});
    }
    const auto& place = options_.placement;
    if (place[Unit::kTractor]) M_canvas_tractor_ = Shift(*place[Unit::kTractor]);
    if (place[Unit::kTrailer]) M_loose_[Unit::kTrailer] = Shift(*place[Unit::kTrailer]);
    const double zoom = options_.border == Border::kCovered ? 1 / options_.cropping : 1.0;
    const Matrix3d zoomed = ZoomAbout(canvas_.Centre(), zoom);
    M_canvas_tractor_ = zoomed * M_canvas_tractor_;
    M_loose_[Unit::kTrailer] = zoomed * M_loose_[Unit::kTrailer];
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
    if (placement_->acquired()) {
        Guide(record);
    } else if (analysed_ % kAcquireEvery == 0) {
        AcquireTrailer(record);
    }
    UpdateSeams(record);
    record.M_tractor_trailer = placement_->M_tractor_trailer();
    record.placed = placement_->acquired();
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
    c.M_canvas_view[Unit::kTractor] = M_canvas_tractor_ * stabilizer_[Unit::kTractor][0];
    if (has_trailer()) {
        const Matrix3d loose = canvas_.IsRing() ? M_canvas_tractor_ : M_loose_[Unit::kTrailer];
        c.M_canvas_view[Unit::kTrailer] =
            (record.placed ? Matrix3d(M_canvas_tractor_ * hitch_pose_[0]) : loose) *
            stabilizer_[Unit::kTrailer][0];
    }
    c.view_offset = view_offset_;
    c.seams = record.seams;
    c.matches = record.matches;
    c.features = record.features;
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
