#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/frame_pool.hpp"
#include "hal/ring.hpp"

namespace hitchview::app {

/// Steps when there is something to do, so that one thread can wait for several sources of work.
/// Any thread.
class WorkBell {
 public:
    void Ring() {
        rings_.fetch_add(1, std::memory_order_release);
        rings_.notify_one();
    }
    [[nodiscard]] std::uint32_t rings() const { return rings_.load(std::memory_order_acquire); }
    /// Returns once it has rung since `rings` was read.
    void WaitWhile(std::uint32_t rings) const { rings_.wait(rings, std::memory_order_acquire); }

 private:
    std::atomic<std::uint32_t> rings_{0};
};

/// What became of the frames that were to be recorded.
struct TapCounts {
    std::uint64_t offered = 0;
    std::uint64_t dropped = 0;  ///< of these: nobody had taken the earlier ones, or none was free
};

/// Lets a second reader, on a thread of its own, see one camera's frames: each lease becomes two
/// that share the frame. It goes back to the camera when both are gone. Closed until Open. Takes no
/// memory after construction.
class FrameTap final : private hal::FrameOwner {
 public:
    static constexpr std::size_t kCapacity = 4;  ///< frames that wait for the reader
    /// Frames that the reader keeps lent at most, the one that it works on among them.
    static constexpr int kHeld = static_cast<int>(kCapacity) + 1;

    enum class WhenFull {
        kDrop,  ///< the reader does not get the frame, and it is counted; nobody waits
        kWait,
    };

    FrameTap() = default;

    /// From now on each `every`-th frame, by its number, is offered; `bell` rings for each.
    void Open(WhenFull when_full, std::uint32_t every, WorkBell& bell);
    /// No frame is offered any more, and who waits returns. What was offered can be taken.
    void Close();

    /// The lease to go on with. Thread: the camera's.
    hal::FrameLease Offer(hal::FrameLease lease);
    /// The oldest that was offered; empty if there is none. Thread: the reader's.
    std::optional<hal::FrameLease> Take();
    /// Any thread.
    [[nodiscard]] TapCounts counts() const { return {offered_.load(), dropped_.load()}; }

 private:
    static constexpr std::size_t kShared = 64;  // frames of a pool at most

    struct Shared {
        hal::FrameLease original;
        std::atomic<int> users{0};
    };

    void DoReturn(int slot) override;
    bool Append(hal::FrameLease lease);
    [[nodiscard]] std::optional<int> TakeSlot();

    std::array<Shared, kShared> shared_;
    std::atomic<std::uint64_t> free_{~std::uint64_t{0}};  // of shared_
    hal::Ring<hal::FrameLease, kCapacity> waiting_;
    WorkBell taken_;
    std::atomic<bool> open_{false};
    WhenFull when_full_ = WhenFull::kDrop;  // this and the next two: before open_ is set
    std::uint32_t every_ = 1;
    WorkBell* bell_ = nullptr;
    std::atomic<std::uint64_t> offered_{0};
    std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace hitchview::app
