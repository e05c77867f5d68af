#include "app/camera_watch.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/pipeline.hpp"

namespace hitchview::app {
namespace {

using hal::CameraState;
using hal::EventCode;

struct Words {
    EventCode code;
    const char* text;
};

Words WordsFor(CameraState state) {
    switch (state) {
        case CameraState::kGood:
            return {EventCode::kCameraBack, "well again"};
        case CameraState::kLost:
            return {EventCode::kCameraLost, "lost: gives no frames"};
        case CameraState::kLate:
            return {EventCode::kCameraLate, "not shown: its frames come too late"};
        case CameraState::kDisordered:
            return {EventCode::kCameraDisordered, "not shown: its time stamps go back"};
        case CameraState::kBlack:
            return {EventCode::kCameraBlack, "not shown: nothing but darkness"};
        case CameraState::kBlinded:
            return {EventCode::kCameraBlinded, "most of the picture is white"};
        case CameraState::kFrozen:
            return {EventCode::kCameraFrozen, "not shown: the same picture over and over"};
        case CameraState::kStuck:
            return {EventCode::kCameraStuck, "the numbers of its frames do not step"};
        case CameraState::kBlurred:
            return {EventCode::kCameraBlurred, "no fine detail: dirty, wet or out of focus"};
        case CameraState::kDirty:
            return {EventCode::kCameraDirty, "parts of the picture have lost their detail"};
    }
    return {EventCode::kCameraLost, "unknown"};
}

hal::EventText TextOf(CameraState before, CameraState state, hal::Instant lasted) {
    hal::EventText text(WordsFor(state).text);
    if (state != CameraState::kGood) return text;
    const auto lasted_ms = std::chrono::duration_cast<std::chrono::milliseconds>(lasted);
    return text.Append(" after ")
        .AppendNumber(lasted_ms.count())
        .Append(" ms: was ")
        .Append(hal::ToString(before));
}

constexpr bool Has(std::uint32_t mask, std::size_t camera) {
    return (mask >> camera & 1U) != 0;
}

}  // namespace

CameraWatch::CameraWatch(std::vector<WatchedPicture> cameras, hal::Instant period,
                         EventQueue& events, const hal::Clock& clock, hal::Instant patience)
    : period_(period), events_(events), clock_(clock), patience_(patience) {
    HV_EXPECT(cameras.size() <= kMaxCameras);
    for (WatchedPicture& picture : cameras) cameras_.emplace_back(std::move(picture), period);
}

void CameraWatch::Look(FrameSet& set) {
    pictures_.Begin();
    std::array<CameraSigns, kMaxCameras> signs{};
    const hal::Instant moment = MomentOf(set);
    for (std::size_t i = 0; i < cameras_.size(); ++i) signs[i] = Look(i, set, moment);
    pictures_.Finish(signs);
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        const bool has_picture =
            static_cast<bool>(LeaseOf(set, i)) && !signs[i][CameraState::kLate];
        cameras_[i].judge.Note(signs[i], has_picture);
        if (pictures_.SeemsRepeated(i)) set.cameras_repeated |= 1U << i;
        Decide(i, set, !has_picture);
    }
    set.FindMoments();
}

/// The middle one of the stamps: a camera whose clock is wrong makes no other one look late.
hal::Instant CameraWatch::MomentOf(const FrameSet& set) const {
    std::array<hal::Instant, kMaxCameras> stamps{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < cameras_.size(); ++i)
        if (const auto& lease = LeaseOf(set, i)) stamps[count++] = lease.view().header.captured_at;
    if (count == 0) return set.captured_until;
    const auto middle = stamps.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(stamps.begin(), middle, stamps.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

CameraSigns CameraWatch::Look(std::size_t index, const FrameSet& set, hal::Instant moment) {
    Camera& camera = cameras_[index];
    const hal::FrameLease& lease = LeaseOf(set, index);
    CameraSigns signs;
    bool stamp_went_back = Has(set.cameras_disordered, index);
    if (lease) {
        const hal::FrameHeader& header = lease.view().header;
        if (camera.newest) {
            stamp_went_back |= header.captured_at <= camera.newest->captured_at;
            signs[CameraState::kStuck] = header.sequence == camera.newest->sequence;
        }
        camera.newest = header;
        const hal::Instant apart =
            std::max(moment - header.captured_at, header.captured_at - moment);
        signs[CameraState::kLate] = apart > 3 * period_ / 2;
        pictures_.Add(index, Borrow(lease));
    } else {
        signs[CameraState::kLate] = Has(set.cameras_late, index);
        signs[CameraState::kLost] = !signs[CameraState::kLate] && !stamp_went_back;
    }
    camera.sets_since_disorder =
        stamp_went_back ? 0 : std::min(camera.sets_since_disorder + 1, kDisorderLasts);
    signs[CameraState::kDisordered] = camera.sets_since_disorder < kDisorderLasts;
    return signs;
}

void CameraWatch::Decide(std::size_t index, FrameSet& set, bool too_old) {
    Camera& camera = cameras_[index];
    const CameraState state = camera.judge.state();
    if (state == CameraState::kLost) camera.newest.reset();
    set.camera_states[index] = state;
    if (state != camera.told || state == CameraState::kLost || camera.lost_at)
        Tell(camera, state, Has(set.cameras_gone, index));
    if (hal::IsShown(state) && !too_old) return;
    LeaseOf(set, index).Release();
    set.cameras_missing |= 1U << index;
}

/// A loss that has been told is not told again, nor is its end.
void CameraWatch::Tell(Camera& camera, CameraState state, bool device_gone) {
    const hal::Instant now = clock_.Now();
    NoteDevice(camera, state, device_gone, now);
    if (state != CameraState::kLost) camera.lost_at.reset();
    if (state == camera.told) return;
    if (state == CameraState::kLost) {
        if (!camera.lost_at) camera.lost_at = now;
        if (!camera.device_told && now - *camera.lost_at < patience_) return;
    }
    const bool known =
        camera.device_told && (state == CameraState::kLost ||
                               (state == CameraState::kGood && camera.told == CameraState::kLost));
    if (!known) Put(camera, state, now);
    if (camera.told == CameraState::kGood) camera.told_at = now;
    if (state == CameraState::kGood) camera.device_told = false;
    camera.told = state;
}

/// A device that is had again is told to be back with its first frame; if no good one follows, that
/// was too early, and the loss is told anew.
void CameraWatch::NoteDevice(Camera& camera, CameraState state, bool device_gone,
                             hal::Instant now) {
    camera.device_told |= device_gone;
    const bool had = camera.device_told && !device_gone && camera.told == CameraState::kLost &&
                     state == CameraState::kLost;
    if (!had) {
        camera.had_since.reset();
        return;
    }
    if (!camera.had_since) camera.had_since = now;
    if (now - *camera.had_since < LivePatience(period_)) return;
    camera.device_told = false;
    Put(camera, state, now);
}

void CameraWatch::Put(const Camera& camera, CameraState state, hal::Instant now) {
    const hal::EventText text = TextOf(camera.told, state, now - camera.told_at);
    if (!events_.is_on_stderr())
        std::fprintf(stderr, "camera %s: %s\n", camera.picture.name.c_str(), text.c_str());
    events_.Put({.code = WordsFor(state).code,
                 .when = now,
                 .subject = std::string_view(camera.picture.name),
                 .text = text});
}

void CameraWatch::Reset() {
    pictures_.Reset();
    for (Camera& camera : cameras_) {
        camera.judge.Reset();
        camera.newest.reset();
        camera.sets_since_disorder = kDisorderLasts;
        camera.told = CameraState::kGood;
        camera.device_told = false;
        camera.had_since.reset();
        camera.lost_at.reset();
    }
}

hal::FrameLease& CameraWatch::LeaseOf(FrameSet& set, std::size_t index) const {
    const WatchedPicture& picture = cameras_[index].picture;
    return set.leases[picture.unit][picture.index_in_unit];
}

const hal::FrameLease& CameraWatch::LeaseOf(const FrameSet& set, std::size_t index) const {
    const WatchedPicture& picture = cameras_[index].picture;
    return set.leases[picture.unit][picture.index_in_unit];
}

}  // namespace hitchview::app
