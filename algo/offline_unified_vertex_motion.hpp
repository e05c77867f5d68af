#pragma once

#include <optional>
#include <vector>

#include "algo/canvas_layout.hpp"
#include "algo/paper_stages.hpp"
#include "algo/rig_motion.hpp"
#include "algo/stitching_motion_field.hpp"
#include "algo/vertex_motion.hpp"

namespace hitchview::algo {

struct OfflineOptions {
    UnifiedVertexMotionOptions motion{};  ///< lookahead_frames has no meaning here
    Coupling coupling = Coupling::kCorrected;
    PaperStagesOptions stages{.mu = 0.03};
    double placement_mu = 0.3;  ///< kCorrected: smoothness of the trailer's placement in time
};

/// Unified vertex motion in the paper's form, over a whole recording in two passes: learn every
/// frame set, solve, then step through the same sets again. Memory grows with the recording, by
/// about 40 kB for a frame set.
///
/// Stage 1 is solved for all vertices of each unit's view. kLiteral then adds the stitching
/// profiles at the same vertices and solves stages 2 and 3 as written. kCorrected evaluates V -
/// kappa dS directly: it measures, at the features themselves, what the two stabilised views leave
/// between them. Of that the rigid part moves the trailer's whole view, and the rest is a field on
/// the canvas that lives in the overlap alone; both are smoothed in time by their confidence.
class OfflineUnifiedVertexMotion final : public VertexMotion {
 public:
    /// `geometry[kTrailer]` may be empty. The canvas and both views have the same projection.
    OfflineUnifiedVertexMotion(const Projection& canvas,
                               const PerUnit<std::optional<UnitGeometry>>& geometry,
                               const OfflineOptions& options);

    bool Prime(const RigFrames& frames, TaskRunner& runner) override;

    /// First pass: the next frame set of the recording.
    void Learn(const RigFrames& frames, TaskRunner& runner);
    /// After the last one.
    void Solve();

    /// Second pass: the composition of the next frame set; empty after the last that was learnt.
    const Composition* Step(const RigFrames& frames, TaskRunner& runner) override;
    const Composition* Flush() override { return nullptr; }
    void Reset() override { shown_ = 0; }

 private:
    [[nodiscard]] bool literal() const {
        return options_.coupling == Coupling::kLiteral && trailer_view_.has_value();
    }
    void SolveLiterally();
    void SolveCorrected();

    void Describe();
    [[nodiscard]] Profiles Trajectories(Unit unit) const;
    void Warp(Unit unit, const Profiles& warp);
    void Place();
    void Stitch();
    void Measure(Profiles& discrepancy, Profiles& confidence) const;
    [[nodiscard]] CanvasPairs PairsOnCanvas(std::size_t frame, Overlap overlap) const;
    [[nodiscard]] Profiles StitchingProfiles(Unit unit) const;

    [[nodiscard]] const Projection& view(Unit unit) const {
        return unit == Unit::kTractor ? tractor_view_ : *trailer_view_;
    }
    [[nodiscard]] int units() const { return trailer_view_ ? 2 : 1; }

    Projection canvas_;
    Projection tractor_view_;
    std::optional<Projection> trailer_view_;
    OfflineOptions options_;
    RigMotionEstimator estimator_;
    CanvasLayout layout_;
    std::vector<RigMotion> learnt_;
    std::vector<Composition> compositions_;
    std::size_t shown_ = 0;
};

}  // namespace hitchview::algo
