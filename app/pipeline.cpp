#include "app/pipeline.hpp"

#include "algo/unified_options.hpp"
#include "app/camera_watch.hpp"

namespace hitchview::app {
namespace {

/// Gains follow slowly, so the overlaps need not be looked at in every frame.
constexpr std::uint64_t kGainsEvery = 4;

algo::PixelLayout LayoutOf(hal::PixelFormat format) {
    switch (format) {
        case hal::PixelFormat::kUyvy:
            return algo::PixelLayout::kUyvy;
        case hal::PixelFormat::kYuyv:
            return algo::PixelLayout::kYuyv;
        case hal::PixelFormat::kGrey:
            return algo::PixelLayout::kGrey;
        default:
            HV_EXPECT(format == hal::PixelFormat::kNv12);  // no camera delivers planar pictures
            return algo::PixelLayout::kNv12;
    }
}

hal::FrameFormat CanvasFormat(const algo::Projection& canvas) {
    return {canvas.width_px, canvas.height_px, hal::PixelFormat::kI420, hal::Range::kFull};
}

}  // namespace

algo::CameraFrame Borrow(const hal::FrameLease& lease) {
    if (!lease) return {};
    const hal::FrameView& view = lease.view();
    const algo::PixelLayout layout = LayoutOf(view.format.pixel_format);
    const hal::Plane& chroma = view.planes[layout == algo::PixelLayout::kNv12 ? 1 : 0];
    return {.width_px = view.format.width_px,
            .height_px = view.format.height_px,
            .luma = view.planes[0].data,
            .luma_stride_bytes = view.planes[0].stride_bytes,
            .chroma = chroma.data,
            .chroma_stride_bytes = chroma.stride_bytes,
            .layout = layout,
            .range = view.format.range == hal::Range::kFull ? algo::SampleRange::kFull
                                                            : algo::SampleRange::kLimited};
}

algo::RigFrames Borrow(const FrameSet& set) {
    algo::RigFrames frames;
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < algo::kMaxCameras; ++i)
            frames[unit][i] = Borrow(set.leases[unit][i]);
    }
    return frames;
}

/// A picture that comes twice says that nothing moves: the motion is told without it.
algo::RigFrames Pipeline::WhatMoves(const FrameSet& set) const {
    algo::RigFrames frames = Borrow(set);
    std::uint32_t repeated = set.cameras_repeated;
    for (const algo::Unit unit : algo::kUnits) {
        const int cameras = rig_.units[unit] ? rig_.units[unit]->cameras() : 0;
        for (int i = 0; i < cameras; ++i, repeated >>= 1)
            if ((repeated & 1U) != 0) frames[unit][static_cast<std::size_t>(i)] = {};
    }
    return frames;
}

Pipeline::Pipeline(const RigGeometry& rig, algo::VertexMotion& motion, algo::TaskRunner& runner)
    : rig_(rig),
      runner_(runner),
      motion_(motion),
      map_(rig_.canvas, rig_.units, algo::SeamOptionsOf(rig_.canvas)),
      gains_(exposure_.gains()),
      bands_(map_),
      reduction_(rig_.units),
      format_(CanvasFormat(rig.canvas)),
      panorama_(hal::FrameBytes(format_)),
      view_(hal::FrameBytes(format_)) {}

bool Pipeline::Prime(const FrameSet& set) {
    return motion_.Prime(Borrow(set), runner_);
}

void Pipeline::Start() {
    motion_.Reset();
    exposure_.Reset();
    gains_ = exposure_.gains();
    renderer_.SetGains(gains_);
    for (FrameSet& set : held_) set = FrameSet{};
    taken_ = shown_ = 0;
}

const ShownPanorama* Pipeline::Process(FrameSet&& set) {
    const StageTimer total(times_, Stage::kTotal);
    ReleaseShown();
    FrameSet& held = held_[taken_++ % held_.size()];
    held = std::move(set);
    if (watch_ != nullptr) {
        const StageTimer timer(times_, Stage::kWatch);
        watch_->Look(held);
    }
    const algo::Composition* composition = nullptr;
    {
        const StageTimer timer(times_, Stage::kMotion);
        composition = motion_.Step(WhatMoves(held), runner_);
    }
    return composition != nullptr ? Show(*composition) : nullptr;
}

const ShownPanorama* Pipeline::Flush() {
    ReleaseShown();
    const algo::Composition* composition = motion_.Flush();
    return composition != nullptr ? Show(*composition) : nullptr;
}

/// Before a new set comes: with the longest lookahead it goes where the one shown last was.
void Pipeline::ReleaseShown() {
    if (shown_ == 0) return;
    FrameSet& set = held_[(shown_ - 1) % held_.size()];
    if (shown_sets_ != nullptr) shown_sets_->Offer(set);
    set = FrameSet{};
}

const ShownPanorama* Pipeline::Show(const algo::Composition& composition) {
    const FrameSet& set = held_[shown_ % held_.size()];
    shown_frames_ = Borrow(set);
    const algo::RigFrames& frames = shown_frames_;
    const algo::RigPictures pictures{frames, gains_};
    {
        const StageTimer timer(times_, Stage::kMap);
        map_.Build(composition, pictures, runner_);
    }
    if (shown_ % kGainsEvery == 0) {
        const StageTimer timer(times_, Stage::kGains);
        exposure_.Update(map_, frames);
        gains_ = exposure_.gains();
        renderer_.SetGains(gains_);
    }
    {
        const StageTimer timer(times_, Stage::kBands);
        bands_.Update(map_, pictures, runner_);
    }
    {
        const StageTimer timer(times_, Stage::kRender);
        renderer_.RenderBlended(map_, reduction_.Update(frames, runner_), bands_, Planes(panorama_),
                                runner_);
    }
    ++shown_;
    result_ = {.picture = {format_,
                           {set.sequence, set.captured_from},
                           hal::PackedPlanes(format_, panorama_.data())},
               .captured_until = set.captured_until,
               .cameras_missing = set.cameras_missing,
               .camera_states = set.camera_states,
               .composition = &composition};
    return &result_;
}

hal::FrameView Pipeline::RenderView(algo::Unit unit) {
    HV_EXPECT(shown_ > 0);
    map_.SelectUnit(unit);
    const algo::RigFrames frames = Borrow(held_[(shown_ - 1) % held_.size()]);
    renderer_.Render(map_, reduction_.Update(frames, runner_), algo::NoData::kBlack, Planes(view_),
                     runner_);
    map_.SelectBoth();
    return {format_, result_.picture.header, hal::PackedPlanes(format_, view_.data())};
}

algo::PanoramaPlanes Pipeline::Planes(std::vector<std::uint8_t>& memory) const {
    const std::size_t luma =
        static_cast<std::size_t>(format_.width_px) * static_cast<std::size_t>(format_.height_px);
    return {.width_px = format_.width_px,
            .height_px = format_.height_px,
            .y = memory.data(),
            .y_stride_bytes = format_.width_px,
            .u = memory.data() + luma,
            .v = memory.data() + luma + luma / 4,
            .chroma_stride_bytes = format_.width_px / 2};
}

}  // namespace hitchview::app
