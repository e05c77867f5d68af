#include "app/frame_tap.hpp"

#include <bit>
#include <utility>

#include "hal/expect.hpp"

namespace hitchview::app {

void FrameTap::Open(WhenFull when_full, std::uint32_t every, WorkBell& bell) {
    HV_EXPECT(!open_ && every > 0);
    when_full_ = when_full;
    every_ = every;
    bell_ = &bell;
    open_ = true;
}

void FrameTap::Close() {
    open_ = false;
    taken_.Ring();
}

hal::FrameLease FrameTap::Offer(hal::FrameLease lease) {
    if (!open_ || lease.view().header.sequence % every_ != 0) return lease;
    ++offered_;
    const std::optional<int> slot = TakeSlot();
    if (!slot) {
        ++dropped_;
        return lease;
    }
    Shared& shared = shared_[static_cast<std::size_t>(*slot)];
    const hal::FrameView view = lease.view();
    shared.original = std::move(lease);
    shared.users.store(2, std::memory_order_relaxed);
    if (Append({*this, *slot, view}))
        bell_->Ring();
    else
        ++dropped_;
    return {*this, *slot, view};
}

/// False: it was not appended, and has been given back.
bool FrameTap::Append(hal::FrameLease lease) {
    while (open_) {
        const std::uint32_t rings = taken_.rings();
        if (waiting_.Append(std::move(lease))) return true;
        if (when_full_ == WhenFull::kDrop) return false;
        taken_.WaitWhile(rings);
    }
    return false;
}

std::optional<hal::FrameLease> FrameTap::Take() {
    auto lease = waiting_.Take();
    if (lease) taken_.Ring();
    return lease;
}

std::optional<int> FrameTap::TakeSlot() {
    std::uint64_t free = free_.load(std::memory_order_relaxed);
    while (free != 0) {
        const int slot = std::countr_zero(free);
        if (free_.compare_exchange_weak(free, free & (free - 1), std::memory_order_acquire))
            return slot;
    }
    return std::nullopt;
}

void FrameTap::DoReturn(int slot) {
    Shared& shared = shared_[static_cast<std::size_t>(slot)];
    if (shared.users.fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    shared.original.Release();
    free_.fetch_or(std::uint64_t{1} << slot, std::memory_order_release);
}

}  // namespace hitchview::app
