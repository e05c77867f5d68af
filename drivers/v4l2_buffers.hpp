#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/v4l2_device.hpp"
#include "drivers/v4l2_format.hpp"
#include "hal/frame_pool.hpp"
#include "hal/pool_level.hpp"

namespace hitchview::drivers {

/// The driver's own buffers, mapped once and lent as they are: no byte is copied. Each is also
/// exported as a DMABUF where the driver can, and then mapped through it: such a mapping does not
/// hold the device, so that a device that has gone is let go, and had again, while its last frames
/// are still lent. A buffer that is lent when its stream ends stays mapped until it comes back.
/// No memory from the heap. Thread: the one that takes frames; leases may die on any other, which
/// wakes that one through returned_event().
class V4l2Buffers final : public hal::FrameOwner {
 public:
    static constexpr int kMostBuffers = 32;

    /// `count`: [2, kMostBuffers].
    explicit V4l2Buffers(int count);
    /// All leases have come back.
    ~V4l2Buffers() override;
    V4l2Buffers(const V4l2Buffers&) = delete;
    V4l2Buffers& operator=(const V4l2Buffers&) = delete;

    /// Has the driver allocate the buffers of a new stream. kTooLarge: it gives fewer than asked.
    V4l2Result<hal::Done> Take(const V4l2Device& device, const V4l2Layout& layout,
                               bool export_dmabuf);
    /// Ends the stream's buffers, before the device is closed. Those lent are kept as they are.
    void Drop(V4l2Kernel& kernel);
    /// After Drop, of a device that still answers: the driver lets go of them too, where it can
    /// while some are lent. Closing alone would not do while a program that has just been started
    /// still shares the file.
    void Free(const V4l2Device& device);

    /// Gives the driver every buffer that is neither lent nor queued. One that it refuses is
    /// offered again by the next call; the failure is that of the last one refused.
    V4l2Result<hal::Done> Queue(const V4l2Device& device);
    /// STREAMOFF has taken the buffers from the driver.
    void NoteStopped();

    struct Filled {
        int slot = 0;
        V4l2Payload payload;
        std::uint32_t sequence = 0;
        std::uint32_t flags = 0;
        hal::Instant stamp{};
    };
    /// kTimeout: no frame is ready.
    V4l2Result<Filled> Dequeue(const V4l2Device& device);
    /// Lends what was dequeued. Otherwise the next Queue gives it back to the driver.
    [[nodiscard]] hal::FrameLease Lend(const Filled& filled, const hal::FrameView& view);

    /// The driver has none left: all are lent.
    [[nodiscard]] bool all_lent() const;
    /// Can be read once a lease has come back, until NoteWoken; then Queue.
    [[nodiscard]] int returned_event() const { return returned_event_; }
    void NoteWoken() const;
    /// Buffers are exported and mapped as DMABUF.
    [[nodiscard]] bool exported() const { return exported_; }
    /// Bytes of one mapped buffer; of any while a stream is there.
    [[nodiscard]] std::span<const std::uint8_t> first_mapping() const;
    /// v4l2_buffer::flags of a buffer that was never filled: clock and source of the stamps.
    [[nodiscard]] std::uint32_t stamp_flags() const { return stamp_flags_; }
    /// Any thread.
    [[nodiscard]] hal::PoolLevel level() const { return {count_, low_water_}; }

    struct Dmabuf {
        int file = -1;
        std::ptrdiff_t offset_bytes = 0;
    };
    /// The DMABUF that `data` lies in; file -1: none.
    [[nodiscard]] Dmabuf FindDmabuf(const std::uint8_t* data) const;

 private:
    enum class State : std::uint8_t { kEmpty, kIdle, kQueued, kLent, kOrphaned };

    struct Mapping {
        std::uint8_t* address = nullptr;
        std::size_t bytes = 0;
        int dmabuf = -1;
    };
    struct Slot {
        State state = State::kEmpty;
        std::uint32_t driver_index = 0;
        std::array<Mapping, 3> planes{};
    };

    /// Those of one stream, and those of earlier ones that are still lent.
    static constexpr int kSlots = 64;

    void DoReturn(int slot) override;
    void Collect(V4l2Kernel& kernel);
    void Unmap(V4l2Kernel& kernel, Slot& slot);
    V4l2Result<hal::Done> Request(const V4l2Device& device);
    V4l2Result<hal::Done> MapBuffer(const V4l2Device& device, std::uint32_t index);
    V4l2Result<Mapping> Map(const V4l2Device& device, std::uint32_t index, std::uint32_t plane,
                            const v4l2_plane& told);
    bool Export(const V4l2Device& device, std::uint32_t index, std::uint32_t plane,
                Mapping& mapping);
    V4l2Result<hal::Done> QueueSlot(const V4l2Device& device, Slot& slot);
    [[nodiscard]] Slot* FindEmpty();
    [[nodiscard]] int FindQueued(std::uint32_t driver_index) const;
    [[nodiscard]] int lent() const;

    int count_;
    int returned_event_;
    int memory_planes_ = 1;
    bool export_wanted_ = true;
    bool exported_ = false;
    bool lets_go_ = false;  ///< V4L2_BUF_CAP_SUPPORTS_ORPHANED_BUFS
    std::uint32_t stamp_flags_ = 0;
    std::array<Slot, kSlots> slots_{};
    std::uint64_t lent_ = 0;  ///< slots of this stream that are lent
    std::atomic<std::uint64_t> returned_ = 0;
    std::atomic<int> low_water_;
};

}  // namespace hitchview::drivers
