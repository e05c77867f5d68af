#include "app/frame_inbox.hpp"

#include <algorithm>
#include <utility>

namespace hitchview::app {

void FrameInbox::Put(std::size_t camera, hal::FrameLease frame, hal::Instant now) {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    Place& place = places_[camera];
    place.connected = true;
    ++place.counts.put;
    const hal::Instant before = std::exchange(place.newest_stamp, frame.view().header.captured_at);
    if (place.newest_stamp <= before) {
        ++place.counts.disordered;
        refused_.disordered[camera] = true;
        return;
    }
    place.heard_at = now;
    place.pace.Add(frame.view().header);
    auto& [head, next] = place.frames;
    if (head && next) {
        head = std::move(next);
        ++place.counts.superseded;
    }
    (head ? next : head) = std::move(frame);
    changed_.notify_one();
}

void FrameInbox::SetConnected(std::size_t camera, bool connected) {
    const std::lock_guard lock(mutex_);
    Place& place = places_[camera];
    place.connected = connected;
    if (!connected) place.pace.Restart();
    changed_.notify_one();
}

void FrameInbox::Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    for (Place& place : places_) {
        for (hal::FrameLease& frame : place.frames) frame.Release();
    }
}

PendingFrames FrameInbox::Visit::Pending(hal::Instant now, hal::Instant patience) const {
    PendingFrames pending;
    for (std::size_t i = 0; i < kMaxCameras; ++i) {
        const Place& place = inbox_.places_[i];
        const auto& [head, next] = place.frames;
        if (head) pending.heads[i] = head.view().header.captured_at;
        pending.followed[i] = static_cast<bool>(next);
        pending.awaited[i] =
            i < inbox_.cameras_ && place.connected && now - place.heard_at < patience;
    }
    return pending;
}

hal::Instant FrameInbox::Visit::heard_at() const {
    hal::Instant newest{};
    for (const Place& place : inbox_.places_) newest = std::max(newest, place.heard_at);
    return newest;
}

hal::FrameLease FrameInbox::Visit::Take(std::size_t camera) {
    Place& place = inbox_.places_[camera];
    HV_EXPECT(place.frames[0]);
    ++place.counts.taken;
    return std::exchange(place.frames[0], std::move(place.frames[1]));
}

void FrameInbox::Visit::SetAside(const CameraMask& cameras) {
    for (std::size_t i = 0; i < kMaxCameras; ++i) {
        if (!cameras[i]) continue;
        Place& place = inbox_.places_[i];
        place.frames[0] = std::move(place.frames[1]);
        ++place.counts.set_aside;
        inbox_.refused_.late[i] = true;
    }
}

CameraMask FrameInbox::Visit::Gone() const {
    CameraMask gone;
    for (std::size_t i = 0; i < inbox_.cameras_; ++i) gone[i] = !inbox_.places_[i].connected;
    return gone;
}

FrameInbox::Visit::Refused FrameInbox::Visit::TakeRefused() {
    return std::exchange(inbox_.refused_, {});
}

void FrameInbox::Visit::Wait(std::chrono::nanoseconds timeout) {
    inbox_.changed_.wait_for(lock_, timeout);
}

std::uint64_t FrameInbox::Visit::Unused() const {
    std::uint64_t unused = 0;
    for (const Place& place : inbox_.places_)
        unused += place.counts.superseded + place.counts.set_aside;
    return unused;
}

InboxCounts FrameInbox::counts(std::size_t camera) const {
    const std::lock_guard lock(mutex_);
    const Place& place = places_[camera];
    InboxCounts counts = place.counts;
    counts.pending = (place.frames[0] ? 1U : 0U) + (place.frames[1] ? 1U : 0U);
    return counts;
}

CameraPace FrameInbox::pace(std::size_t camera) const {
    const std::lock_guard lock(mutex_);
    return places_[camera].pace;
}

}  // namespace hitchview::app
