#pragma once

#include <array>
#include <memory>
#include <optional>

#include "algo/canvas_layout.hpp"
#include "algo/composition.hpp"
#include "algo/detail_field.hpp"
#include "algo/path_smoother.hpp"
#include "algo/picture_map.hpp"
#include "algo/rig_motion.hpp"
#include "algo/stitching_motion_field.hpp"
#include "algo/vertex_motion.hpp"

namespace hitchview::algo {

/// Unified vertex motion in its live form (docs/algorithm.md, section 5): causal, fixed memory, one
/// step per frame set. A rig has a tractor and perhaps a trailer.
class UnifiedVertexMotion final : public VertexMotion {
 public:
    /// `geometry[kTrailer]` may be empty. The canvas and both views have the same projection.
    UnifiedVertexMotion(const Projection& canvas,
                        const PerUnit<std::optional<UnitGeometry>>& geometry,
                        const UnifiedVertexMotionOptions& options);
    ~UnifiedVertexMotion() override;

    /// Before the first step: matches the two views of one frame set to lay them out on the canvas
    /// (plane) or to find the trailer (ring). True once that is done; else try the next set.
    bool Prime(const RigFrames& frames, TaskRunner& runner) override;

    /// One frame set in. `late` = frames.lookahead: the composition for the set given that many
    /// steps ago; empty while there is none yet.
    const Composition* Step(const RigFrames& frames, TaskRunner& runner) override;
    /// After the last set: the compositions that the lookahead still holds back, one per call.
    /// Not twice in a row: matches are never missed for long.
    bool LightenNextStep() override;
    const Composition* Flush() override;
    /// Forgets everything that crosses frames; the layout stays.
    void Reset() override;

    [[nodiscard]] bool has_trailer() const { return trailer_view_.has_value(); }

 private:
    void UpdateGuess();
    const Composition* Emit(std::int64_t index, TaskRunner& runner);
    void Stabilise(std::int64_t index, Unit unit);
    void PlaceTrailer(const RigMotion& record);
    void UpdateViewOffset(const RigMotion& record, Unit unit);
    void ShowNoDetail();
    void UpdateDetail(const RigParallax& parallax, TaskRunner& runner);
    [[nodiscard]] RigParallax* ParallaxAt(std::int64_t index);
    void UpdateDetail(const ParallaxSamples& samples, Overlap overlap);
    void UpdateStitching(const RigMotion& record, const Eigen::Matrix3d& M_canvas_early);
    void TakePairs(const InterFeatures& features);
    void Compose(const RigMotion& record);
    [[nodiscard]] PathSmoother::Window Window(std::int64_t index, Unit unit) const;
    [[nodiscard]] Eigen::Vector2d Moved(Unit unit, const Eigen::Vector2d& view_px) const;
    [[nodiscard]] Eigen::Vector2d OnCanvas(Unit unit, const Eigen::Vector2d& view_px) const;
    void LayOut();

    [[nodiscard]] RigMotion& At(std::int64_t index);
    [[nodiscard]] const RigMotion& At(std::int64_t index) const;
    [[nodiscard]] const Projection& view(Unit unit) const {
        return unit == Unit::kTractor ? tractor_view_ : *trailer_view_;
    }
    [[nodiscard]] int units() const { return has_trailer() ? 2 : 1; }

    Projection canvas_;
    Projection tractor_view_;
    std::optional<Projection> trailer_view_;
    PerUnit<Mesh> view_mesh_;
    UnifiedVertexMotionOptions options_;

    RigMotionEstimator estimator_;
    MatchGuess guess_;
    double max_parallax_px_;
    double max_mesh_parallax_px_;
    StitchingMotionField stitching_;
    std::unique_ptr<DetailField> detail_;             // ring with a trailer
    PerUnit<std::unique_ptr<PictureMap>> on_canvas_;  // likewise
    PerUnit<std::unique_ptr<UnitSmoother>> smoother_;
    std::unique_ptr<PathSmoother> hitch_smoother_;

    CanvasLayout layout_;
    PerUnit<std::array<Eigen::Matrix3d, 2>>
        stabilizer_;                             // of the frames emitted last, newest first
    std::array<Eigen::Matrix3d, 2> hitch_pose_;  // likewise: smoothed trailer placement
    Eigen::Matrix3d raw_hitch_pose_ = Eigen::Matrix3d::Identity();  // before smoothing
    double hitch_scale_ = 1;
    bool hitch_known_ = false;
    PerUnit<VertexField> view_offset_{{VertexField::Zero(), VertexField::Zero()}};

    static constexpr int kRecords = 16;
    std::unique_ptr<std::array<RigMotion, kRecords>> records_;
    std::unique_ptr<std::array<RigParallax, kRecords>> parallax_;  // ring with a trailer
    std::int64_t analysed_ = 0;                                    // frame sets seen
    std::int64_t emitted_ = 0;
    CanvasPairs canvas_pairs_;
    Composition composition_;
};

}  // namespace hitchview::algo
