#pragma once

#include <libcamera/camera.h>
#include <libcamera/framebuffer_allocator.h>

#include <array>
#include <atomic>
#include <memory>

#include "drivers/libcamera_format.hpp"
#include "drivers/libcamera_mailbox.hpp"
#include "hal/frame_pool.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// Buffers and requests of a camera's stream, taken once and used again and again, and mapped for
/// the processor. A buffer that is lent when the stream ends stays mapped until it comes back; its
/// memory lives as long. Thread: one at a time, but for leases that end.
class LibcameraBuffers final : public hal::FrameOwner {
 public:
    explicit LibcameraBuffers(LibcameraMailbox& mailbox) : mailbox_(mailbox) {}
    /// The stream has been dropped, all leases have come back.
    ~LibcameraBuffers() override;
    LibcameraBuffers(const LibcameraBuffers&) = delete;
    LibcameraBuffers& operator=(const LibcameraBuffers&) = delete;

    /// Of a camera that is configured. Each request's cookie is its slot.
    hal::Checked<hal::Done> Take(const std::shared_ptr<libcamera::Camera>& camera,
                                 libcamera::Stream* stream);
    /// After the camera has stopped, before it is released.
    void Drop();

    /// Gives the camera every buffer that is idle; the first one with `controls`, if there are any.
    /// 0, or the last refusal, a negative errno: what was refused is offered again by the next
    /// call. We take no memory from the heap; libcamera does.
    int Queue(libcamera::Camera& camera, const libcamera::ControlList* controls = nullptr);
    /// What the mailbox tells to have been returned.
    void Collect(std::uint64_t returned);
    /// The camera is done with a buffer; it is idle until it is lent.
    void NoteFilled(int slot) { At(slot).state = State::kIdle; }
    [[nodiscard]] hal::FrameLease Lend(int slot, const hal::FrameView& view);

    [[nodiscard]] libcamera::Request& request(int slot) { return *At(slot).request; }
    [[nodiscard]] const libcamera::FrameBuffer& buffer(int slot) { return *At(slot).buffer; }
    [[nodiscard]] LibcameraPlanes memory(int slot);
    [[nodiscard]] int count() const { return count_; }
    [[nodiscard]] bool all_lent() const { return lent_ >= count_; }
    /// Any thread.
    [[nodiscard]] hal::PoolLevel level() const { return {count_, low_water_}; }

 private:
    enum class State : std::uint8_t { kEmpty, kIdle, kQueued, kLent, kOrphaned };

    struct Mapping {
        void* address = nullptr;
        std::size_t bytes = 0;
        std::span<const std::uint8_t> plane;  ///< its part
    };
    struct Slot {
        State state = State::kEmpty;
        bool used = false;  ///< its request has been queued before
        libcamera::FrameBuffer* buffer = nullptr;
        std::unique_ptr<libcamera::Request> request;
        std::array<Mapping, 3> planes{};
    };

    void DoReturn(int slot) override { HV_EXPECT(mailbox_.NoteReturned(slot)); }
    Slot& At(int slot) { return slots_.at(static_cast<std::size_t>(slot)); }
    hal::Checked<hal::Done> TakeOne(libcamera::Camera& camera, libcamera::Stream* stream,
                                    libcamera::FrameBuffer& buffer);
    static hal::Checked<Mapping> Map(const libcamera::FrameBuffer::Plane& plane);
    static void Unmap(Slot& slot);

    LibcameraMailbox& mailbox_;
    std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
    libcamera::Stream* stream_ = nullptr;
    std::array<Slot, LibcameraMailbox::kSlots> slots_{};
    int lent_ = 0;  ///< of this stream
    std::atomic<int> count_ = 0;
    std::atomic<int> low_water_ = 0;
};

}  // namespace hitchview::drivers
