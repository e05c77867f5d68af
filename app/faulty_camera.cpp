#include "app/faulty_camera.hpp"

#include <algorithm>
#include <utility>

#include "app/packed_frame.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;

bool TakesTheDevice(FaultKind kind) {
    return kind == FaultKind::kDead || kind == FaultKind::kOtherFormat;
}

/// Of a tightly packed frame.
WritableLuma LumaOf(const hal::FrameFormat& format, std::span<std::uint8_t> bytes) {
    const bool packed = format.pixel_format == hal::PixelFormat::kUyvy ||
                        format.pixel_format == hal::PixelFormat::kYuyv;
    const int step = packed ? 2 : 1;
    const int at = format.pixel_format == hal::PixelFormat::kUyvy ? 1 : 0;
    return {.first = bytes.data() + at,
            .stride_bytes = step * format.width_px,
            .step_bytes = step,
            .cols = format.width_px,
            .rows = format.height_px};
}

}  // namespace

FaultyCamera::FaultyCamera(std::unique_ptr<hal::Camera> camera, std::vector<CameraFault> faults,
                           const Pace& pace, int slots)
    : camera_(std::move(camera)),
      faults_(std::move(faults)),
      pace_(pace),
      pool_(camera_->format(), slots + static_cast<int>(kLateBy) + 1),
      picture_(camera_->format().width_px, camera_->format().height_px) {}

hal::Result<hal::FrameLease> FaultyCamera::DoWaitFrame(milliseconds timeout) {
    if (is_live() && IsGone(FaultAt(FrameNow()))) {
        befallen_ = FaultAt(FrameNow());
        return hal::Error::kDisconnected;
    }
    auto frame = camera_->WaitFrame(timeout);
    if (!frame) {
        is_lost_by_itself_ = frame.error() == hal::Error::kDisconnected;
        if (frame.error() == hal::Error::kCorrupted) ++frames_given_;
        return frame;
    }
    if (frames_given_ == 0 && is_live()) started_ = pace_.clock->Now();
    const int number = is_live() ? FrameNow() : frames_given_;
    ++frames_given_;
    const CameraFault* const fault = FaultAt(number);
    if (fault != befallen_) {
        for (hal::FrameLease& kept : kept_) kept.Release();
        frames_befallen_ = 0;
        befallen_ = fault;
    }
    if (fault == nullptr) return frame;
    if (frames_befallen_++ == 0) first_ = frame->view().header;
    return Afflict(*fault, std::move(*frame));
}

hal::Result<hal::Done> FaultyCamera::DoReopen() {
    if (is_lost_by_itself_) return camera_->Reopen();
    if (is_live() && IsGone(FaultAt(FrameNow()))) return hal::Error::kNotFound;
    return hal::Done{};
}

hal::CameraLoss FaultyCamera::DoLoss() const {
    if (is_lost_by_itself_ || befallen_ == nullptr) return camera_->loss();
    return befallen_->does == FaultKind::kOtherFormat ? hal::CameraLoss::kOtherFormat
                                                      : hal::CameraLoss::kDisconnected;
}

int FaultyCamera::FrameNow() const {
    if (frames_given_ == 0) return 0;
    return static_cast<int>((pace_.clock->Now() - started_) / pace_.period);
}

const CameraFault* FaultyCamera::FaultAt(int frame) const {
    const auto found = std::ranges::find_if(
        faults_, [frame](const CameraFault& fault) { return fault.Befalls(frame); });
    return found == faults_.end() ? nullptr : &*found;
}

bool FaultyCamera::IsGone(const CameraFault* fault) const {
    return frames_given_ > 0 && fault != nullptr && TakesTheDevice(fault->does);
}

hal::Result<hal::FrameLease> FaultyCamera::Afflict(const CameraFault& fault,
                                                   hal::FrameLease frame) {
    const hal::FrameView& view = frame.view();
    hal::FrameHeader header = view.header;
    switch (fault.does) {
        case FaultKind::kDead:
        case FaultKind::kOtherFormat:
            return hal::Error::kDisconnected;
        case FaultKind::kSilent:
            // Of a camera without a clock each frame is one of a set: the set goes without it.
            return is_live() ? hal::Error::kTimeout : hal::Error::kCorrupted;
        case FaultKind::kDamaged:
            return hal::Error::kCorrupted;
        case FaultKind::kLate:
            return KeepBack(frame.view());
        case FaultKind::kSwappedStamps:
            header.captured_at += frames_befallen_ % 2 == 1 ? pace_.period : -pace_.period;
            return Copy(view, header);
        case FaultKind::kStuckNumbers:
            header.sequence = first_.sequence;
            return Copy(view, header);
        case FaultKind::kFrozen: {
            if (!kept_[0]) {
                auto copy = Copy(view, header);
                if (!copy) return copy;
                kept_[0] = std::move(*copy);
            }
            return Copy(kept_[0].view(), header);
        }
        case FaultKind::kBlack:
        case FaultKind::kBlinded:
        case FaultKind::kBlurred:
        case FaultKind::kDirty:
            return Copy(view, header);
    }
    return frame;
}

hal::Result<hal::FrameLease> FaultyCamera::KeepBack(const hal::FrameView& view) {
    auto copy = Copy(view, view.header);
    if (!copy) return copy;
    hal::FrameLease& place = kept_[static_cast<std::size_t>(frames_befallen_) % kLateBy];
    hal::FrameLease oldest = std::exchange(place, std::move(*copy));
    if (oldest) return oldest;
    return is_live() ? hal::Error::kTimeout : hal::Error::kCorrupted;
}

hal::Result<hal::FrameLease> FaultyCamera::Copy(const hal::FrameView& view,
                                                const hal::FrameHeader& header) {
    const auto maybe_slot = pool_.Take();
    if (!maybe_slot) return is_live() ? hal::Error::kTimeout : hal::Error::kCorrupted;
    PackFrame(view, maybe_slot->bytes);
    Spoil(befallen_->does, maybe_slot->bytes);
    return pool_.Lease(*maybe_slot, header);
}

void FaultyCamera::Spoil(FaultKind kind, std::span<std::uint8_t> bytes) {
    const WritableLuma luma = LumaOf(pool_.format(), bytes);
    if (kind == FaultKind::kBlack) picture_.Blacken(luma);
    if (kind == FaultKind::kBlinded) picture_.Blind(luma);
    if (kind == FaultKind::kBlurred) picture_.Blur(luma);
    if (kind == FaultKind::kDirty) picture_.Smear(luma);
}

}  // namespace hitchview::app
