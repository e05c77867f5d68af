#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "algo/composed_map.hpp"
#include "algo/exposure_gains.hpp"
#include "algo/multiband_blend.hpp"
#include "algo/panorama_renderer.hpp"
#include "algo/path_smoother.hpp"
#include "algo/picture_reduction.hpp"
#include "algo/vertex_motion.hpp"
#include "app/frame_set.hpp"
#include "app/rig_geometry.hpp"
#include "app/stage_times.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// One frame set shown: borrowed until the next call of the pipeline.
struct ShownPanorama {
    hal::FrameView picture;  ///< I420, full range; sequence is the frame set's
    hal::Instant captured_until{};
    std::uint32_t cameras_missing = 0;
    std::array<hal::CameraState, algo::kMaxCameras> camera_states{};
    const algo::Composition* composition = nullptr;
};

/// The pictures of a frame set, borrowed from its leases.
algo::RigFrames Borrow(const FrameSet& set);
algo::CameraFrame Borrow(const hal::FrameLease& lease);

class CameraWatch;

/// Whoever wants frame sets that the pipeline needs no more. Thread: pipeline.
class ShownSets {
 public:
    virtual ~ShownSets() = default;
    /// Takes the set, or leaves it alone. Does not wait.
    void Offer(FrameSet& set) { DoOffer(set); }

 private:
    virtual void DoOffer(FrameSet& set) = 0;
};

/// Frame sets in, panoramas out: estimation, composed map, gains, rendering. Memory is taken at
/// construction. Thread: one.
class Pipeline {
 public:
    /// `motion`: of the same rig, holds back at most kMaxLookahead sets.
    Pipeline(const RigGeometry& rig, algo::VertexMotion& motion, algo::TaskRunner& runner);

    /// Before the first frame set is shown; see VertexMotion::Prime.
    bool Prime(const FrameSet& set);
    /// After Prime: what was seen counts as nothing, the layout stays.
    void Start();

    /// Null: nobody. It must outlive the pipeline's work.
    void SetShownSets(ShownSets* shown_sets) { shown_sets_ = shown_sets; }

    /// Looks at each set before it is used. Null: nobody. It must outlive the pipeline's work.
    void SetWatch(CameraWatch* watch) { watch_ = watch; }

    /// Empty while the lookahead fills. The set's leases are kept until it was shown.
    const ShownPanorama* Process(FrameSet&& set);
    /// After the last set: what the lookahead still holds, one per call; then empty.
    const ShownPanorama* Flush();

    /// The panorama shown last again, with one unit's view alone: warped and placed, before
    /// blending, black where it has no data. Borrowed like the panorama.
    hal::FrameView RenderView(algo::Unit unit);

    /// What the panorama shown last was made of. Borrowed like it.
    [[nodiscard]] algo::RigPictures shown_pictures() const { return {shown_frames_, gains_}; }
    [[nodiscard]] const AllStageTimes& times() const { return times_; }
    [[nodiscard]] const algo::ComposedMap& map() const { return map_; }
    [[nodiscard]] const hal::FrameFormat& format() const { return format_; }

 private:
    [[nodiscard]] algo::RigFrames WhatMoves(const FrameSet& set) const;
    void ReleaseShown();
    const ShownPanorama* Show(const algo::Composition& composition);
    algo::PanoramaPlanes Planes(std::vector<std::uint8_t>& memory) const;

    RigGeometry rig_;
    algo::TaskRunner& runner_;
    algo::VertexMotion& motion_;
    algo::ComposedMap map_;
    algo::ExposureGains exposure_;
    algo::CameraGains gains_;
    algo::MultibandBlend bands_;
    algo::PictureReduction reduction_;
    algo::PanoramaRenderer renderer_;

    hal::FrameFormat format_;
    std::vector<std::uint8_t> panorama_;
    std::vector<std::uint8_t> view_;
    std::array<FrameSet, algo::kMaxLookahead + 1> held_;
    ShownSets* shown_sets_ = nullptr;
    CameraWatch* watch_ = nullptr;
    algo::RigFrames shown_frames_;
    std::uint64_t taken_ = 0;
    std::uint64_t shown_ = 0;
    ShownPanorama result_;
    AllStageTimes times_{};
};

}  // namespace hitchview::app
