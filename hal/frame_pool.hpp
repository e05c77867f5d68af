#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hal/expect.hpp"
#include "hal/frame.hpp"
#include "hal/pool_level.hpp"

namespace hitchview::hal {

/// Gives a borrowed frame back. Thread-safe: a lease may die on another thread than it was born on.
class FrameOwner {
 public:
    virtual ~FrameOwner() = default;

 private:
    friend class FrameLease;
    virtual void DoReturn(int slot) = 0;
};

/// Exclusive use of one frame; given back when destroyed. Must not outlive its owner.
class FrameLease {
 public:
    FrameLease() = default;
    FrameLease(FrameOwner& owner, int slot, const FrameView& view)
        : owner_(&owner), slot_(slot), view_(view) {}
    FrameLease(FrameLease&& other) noexcept
        : owner_(std::exchange(other.owner_, nullptr)), slot_(other.slot_), view_(other.view_) {}
    FrameLease& operator=(FrameLease&& other) noexcept {
        if (this != &other) {
            Release();
            owner_ = std::exchange(other.owner_, nullptr);
            slot_ = other.slot_;
            view_ = other.view_;
        }
        return *this;
    }
    ~FrameLease() { Release(); }

    /// False for a lease that holds nothing: the camera gave no frame.
    explicit operator bool() const { return owner_ != nullptr; }
    [[nodiscard]] const FrameView& view() const {
        HV_EXPECT(owner_ != nullptr);
        return view_;
    }

    void Release() {
        if (owner_ != nullptr) std::exchange(owner_, nullptr)->DoReturn(slot_);
    }

 private:
    FrameOwner* owner_ = nullptr;
    int slot_ = 0;
    FrameView view_;
};

/// Frames of one format in one block of memory, taken at construction. Lock-free.
class FramePool final : public FrameOwner {
 public:
    /// At most 64 slots.
    FramePool(const FrameFormat& format, int slots)
        : format_(format),
          slots_(WithinMask(slots)),
          frame_bytes_((FrameBytes(format) + kAlignment - 1) / kAlignment * kAlignment),
          memory_(frame_bytes_ * static_cast<std::size_t>(slots) + kAlignment),
          free_(slots == 64 ? ~0ULL : (1ULL << slots) - 1),
          low_water_(slots) {}

    /// Memory of one frame, to be written by the taker before Lease.
    struct Slot {
        int index;
        std::span<std::uint8_t> bytes;
    };

    /// Empty when every frame is out.
    [[nodiscard]] std::optional<Slot> Take() {
        std::uint64_t free = free_.load(std::memory_order_relaxed);
        while (free != 0) {
            const int index = __builtin_ctzll(free);
            if (free_.compare_exchange_weak(free, free & (free - 1), std::memory_order_acquire)) {
                NoteLevel(__builtin_popcountll(free) - 1);
                return Slot{index, {Address(index), FrameBytes(format_)}};
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] FrameLease Lease(const Slot& slot, const FrameHeader& header) {
        return {*this, slot.index,
                FrameView{format_, header, PackedPlanes(format_, Address(slot.index))}};
    }

    /// Gives a taken slot back without a lease.
    void Return(const Slot& slot) { DoReturn(slot.index); }

    [[nodiscard]] const FrameFormat& format() const { return format_; }
    /// Fewest frames that were ever free: how close the pool came to running dry.
    [[nodiscard]] int low_water() const { return low_water_.load(std::memory_order_relaxed); }
    [[nodiscard]] PoolLevel level() const { return {slots_, low_water()}; }
    [[nodiscard]] int free_count() const {
        return __builtin_popcountll(free_.load(std::memory_order_relaxed));
    }

 private:
    static constexpr std::size_t kAlignment = 64;

    // Checked before the first member is sized by it.
    static int WithinMask(int slots) {
        HV_EXPECT(slots > 0 && slots <= 64);
        return slots;
    }

    void DoReturn(int slot) override {
        HV_EXPECT(slot >= 0 && slot < slots_);
        const std::uint64_t bit = 1ULL << slot;
        const std::uint64_t before = free_.fetch_or(bit, std::memory_order_release);
        HV_EXPECT((before & bit) == 0);
    }

    void NoteLevel(int level) {
        int lowest = low_water_.load(std::memory_order_relaxed);
        while (level < lowest &&
               !low_water_.compare_exchange_weak(lowest, level, std::memory_order_relaxed)) {
        }
    }

    std::uint8_t* Address(int slot) {
        const auto start = reinterpret_cast<std::uintptr_t>(memory_.data());
        const std::size_t shift = (kAlignment - start % kAlignment) % kAlignment;
        return memory_.data() + shift + frame_bytes_ * static_cast<std::size_t>(slot);
    }

    FrameFormat format_;
    int slots_;
    std::size_t frame_bytes_;
    std::vector<std::uint8_t> memory_;
    std::atomic<std::uint64_t> free_;
    std::atomic<int> low_water_;
};

}  // namespace hitchview::hal
