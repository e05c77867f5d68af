#include "drivers/v4l2_buffers.hpp"

#include <fcntl.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>

namespace hitchview::drivers {
namespace {

/// A v4l2_buffer, single- or multi-planar, with room for its planes.
class BufferMessage {
 public:
    BufferMessage(const V4l2Device& device, std::uint32_t index, int planes)
        : multi_planar_(device.multi_planar()) {
        buffer_.type = device.buffer_type();
        buffer_.memory = V4L2_MEMORY_MMAP;
        buffer_.index = index;
        if (!multi_planar_) return;
        buffer_.m.planes = planes_.data();
        buffer_.length = static_cast<std::uint32_t>(planes);
    }
    BufferMessage(const BufferMessage&) = delete;
    BufferMessage& operator=(const BufferMessage&) = delete;

    v4l2_buffer& message() { return buffer_; }
    /// A single-planar buffer told as one plane.
    [[nodiscard]] v4l2_plane plane(std::size_t i) const {
        if (multi_planar_) return planes_[i];
        v4l2_plane only{};
        only.bytesused = buffer_.bytesused;
        only.length = buffer_.length;
        only.m.mem_offset = buffer_.m.offset;
        return only;
    }

 private:
    bool multi_planar_;
    v4l2_buffer buffer_{};
    std::array<v4l2_plane, VIDEO_MAX_PLANES> planes_{};
};

hal::Instant StampOf(const v4l2_buffer& buffer) {
    return std::chrono::seconds(buffer.timestamp.tv_sec) +
           std::chrono::microseconds(buffer.timestamp.tv_usec);
}

}  // namespace

V4l2Buffers::V4l2Buffers(int count)
    : count_(count), returned_event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)), low_water_(count) {
    HV_EXPECT(count >= 2 && count <= kMostBuffers && returned_event_ >= 0);
}

V4l2Buffers::~V4l2Buffers() {
    close(returned_event_);
}

V4l2Result<hal::Done> V4l2Buffers::Take(const V4l2Device& device, const V4l2Layout& layout,
                                        bool export_dmabuf) {
    Collect(device.kernel());
    memory_planes_ = layout.memory_planes;
    export_wanted_ = export_dmabuf;
    exported_ = export_dmabuf;
    if (const auto requested = Request(device); !requested) return requested.error();
    for (int i = 0; i < count_; ++i) {
        const auto mapped = MapBuffer(device, static_cast<std::uint32_t>(i));
        if (!mapped) return mapped.error();
    }
    return hal::Done{};
}

V4l2Result<hal::Done> V4l2Buffers::Request(const V4l2Device& device) {
    v4l2_requestbuffers request{};
    request.count = static_cast<std::uint32_t>(count_);
    request.type = device.buffer_type();
    request.memory = V4L2_MEMORY_MMAP;
    if (const auto asked = device.Call(VIDIOC_REQBUFS, "VIDIOC_REQBUFS", request); !asked) {
        return asked.error();
    }
    lets_go_ = (request.capabilities & V4L2_BUF_CAP_SUPPORTS_ORPHANED_BUFS) != 0;
    // More than asked is a driver's right; those are simply never queued.
    if (request.count >= static_cast<std::uint32_t>(count_)) return hal::Done{};
    return V4l2Failure{hal::Error::kTooLarge, "VIDIOC_REQBUFS gives fewer buffers than asked", 0};
}

V4l2Result<hal::Done> V4l2Buffers::MapBuffer(const V4l2Device& device, std::uint32_t index) {
    BufferMessage buffer(device, index, memory_planes_);
    if (const auto told = device.Call(VIDIOC_QUERYBUF, "VIDIOC_QUERYBUF", buffer.message());
        !told) {
        return told.error();
    }
    stamp_flags_ = buffer.message().flags;
    Slot* const slot = FindEmpty();
    if (slot == nullptr) {
        return V4l2Failure{hal::Error::kFailed, "frames of earlier streams were never given back",
                           0};
    }
    *slot = {State::kIdle, index, {}};
    for (int i = 0; i < memory_planes_; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const auto mapping = Map(device, index, static_cast<std::uint32_t>(i), buffer.plane(k));
        if (!mapping) return mapping.error();
        slot->planes[k] = mapping.value();
    }
    return hal::Done{};
}

V4l2Result<V4l2Buffers::Mapping> V4l2Buffers::Map(const V4l2Device& device, std::uint32_t index,
                                                  std::uint32_t plane, const v4l2_plane& told) {
    Mapping mapping{nullptr, told.length, -1};
    const bool exported = exported_ && Export(device, index, plane, mapping);
    V4l2Kernel& kernel = device.kernel();
    void* const address = exported ? kernel.Map(mapping.dmabuf, mapping.bytes, 0)
                                   : kernel.Map(device.file(), mapping.bytes, told.m.mem_offset);
    if (address == MAP_FAILED) {
        const V4l2Failure failure{hal::Error::kFailed, "mmap", errno};
        if (exported) kernel.Close(mapping.dmabuf);
        return failure;
    }
    mapping.address = static_cast<std::uint8_t*>(address);
    return mapping;
}

bool V4l2Buffers::Export(const V4l2Device& device, std::uint32_t index, std::uint32_t plane,
                         Mapping& mapping) {
    v4l2_exportbuffer message{};
    message.type = device.buffer_type();
    message.index = index;
    message.plane = plane;
    message.flags = O_CLOEXEC | O_RDWR;
    // A driver that cannot says so of the first buffer; it is not asked again.
    exported_ = device.Call(VIDIOC_EXPBUF, "VIDIOC_EXPBUF", message).ok();
    if (exported_) mapping.dmabuf = message.fd;
    return exported_;
}

void V4l2Buffers::Drop(V4l2Kernel& kernel) {
    Collect(kernel);
    for (Slot& slot : slots_) {
        if (slot.state == State::kIdle || slot.state == State::kQueued) Unmap(kernel, slot);
        if (slot.state == State::kLent) slot.state = State::kOrphaned;
    }
    lent_ = 0;
}

void V4l2Buffers::Free(const V4l2Device& device) {
    if (!lets_go_) return;
    v4l2_requestbuffers none{};
    none.type = device.buffer_type();
    none.memory = V4L2_MEMORY_MMAP;
    static_cast<void>(device.Call(VIDIOC_REQBUFS, "VIDIOC_REQBUFS", none).ok());
}

void V4l2Buffers::Unmap(V4l2Kernel& kernel, Slot& slot) {
    for (const Mapping& plane : slot.planes) {
        if (plane.address != nullptr) kernel.Unmap(plane.address, plane.bytes);
        if (plane.dmabuf >= 0) kernel.Close(plane.dmabuf);
    }
    slot = {};
}

void V4l2Buffers::DoReturn(int slot) {
    HV_EXPECT(slot >= 0 && slot < kSlots);
    const std::uint64_t bit = 1ULL << slot;
    HV_EXPECT((returned_.fetch_or(bit, std::memory_order_release) & bit) == 0);
    eventfd_write(returned_event_, 1);
}

void V4l2Buffers::NoteWoken() const {
    eventfd_t count = 0;
    eventfd_read(returned_event_, &count);
}

void V4l2Buffers::Collect(V4l2Kernel& kernel) {
    std::uint64_t returned = returned_.exchange(0, std::memory_order_acquire);
    lent_ &= ~returned;
    for (; returned != 0; returned &= returned - 1) {
        Slot& slot = slots_[static_cast<std::size_t>(std::countr_zero(returned))];
        if (slot.state == State::kOrphaned) Unmap(kernel, slot);
        if (slot.state == State::kLent) slot.state = State::kIdle;
    }
}

V4l2Result<hal::Done> V4l2Buffers::Queue(const V4l2Device& device) {
    Collect(device.kernel());
    V4l2Result<hal::Done> outcome = hal::Done{};
    for (Slot& slot : slots_) {
        if (slot.state != State::kIdle) continue;
        if (const auto queued = QueueSlot(device, slot); !queued) outcome = queued;
    }
    return outcome;
}

V4l2Result<hal::Done> V4l2Buffers::QueueSlot(const V4l2Device& device, Slot& slot) {
    BufferMessage buffer(device, slot.driver_index, memory_planes_);
    const auto queued = device.Call(VIDIOC_QBUF, "VIDIOC_QBUF", buffer.message());
    if (queued) slot.state = State::kQueued;
    return queued;
}

void V4l2Buffers::NoteStopped() {
    for (Slot& slot : slots_) {
        if (slot.state == State::kQueued) slot.state = State::kIdle;
    }
}

V4l2Result<V4l2Buffers::Filled> V4l2Buffers::Dequeue(const V4l2Device& device) {
    BufferMessage buffer(device, 0, memory_planes_);
    const auto dequeued = device.Call(VIDIOC_DQBUF, "VIDIOC_DQBUF", buffer.message());
    if (!dequeued) return dequeued.error();
    const v4l2_buffer& told = buffer.message();
    const int index = FindQueued(told.index);
    if (index < 0) {
        return V4l2Failure{hal::Error::kDisconnected, "VIDIOC_DQBUF gives a buffer never queued",
                           0};
    }
    Slot& slot = slots_[static_cast<std::size_t>(index)];
    slot.state = State::kIdle;
    Filled filled{index, {}, told.sequence, told.flags, StampOf(told)};
    for (std::size_t i = 0; i < static_cast<std::size_t>(memory_planes_); ++i) {
        const v4l2_plane plane = buffer.plane(i);
        const std::size_t used = std::min<std::size_t>(plane.bytesused, slot.planes[i].bytes);
        const std::size_t skipped = std::min<std::size_t>(plane.data_offset, used);
        filled.payload[i] = {slot.planes[i].address + skipped, used - skipped};
    }
    return filled;
}

hal::FrameLease V4l2Buffers::Lend(const Filled& filled, const hal::FrameView& view) {
    slots_[static_cast<std::size_t>(filled.slot)].state = State::kLent;
    lent_ |= 1ULL << filled.slot;
    low_water_ = std::min(low_water_.load(), count_ - lent());
    return {*this, filled.slot, view};
}

int V4l2Buffers::lent() const {
    return std::popcount(lent_ & ~returned_.load(std::memory_order_relaxed));
}

bool V4l2Buffers::all_lent() const {
    return lent() >= count_;
}

std::span<const std::uint8_t> V4l2Buffers::first_mapping() const {
    const auto slot = std::ranges::find_if(slots_, [](const Slot& candidate) {
        return candidate.state == State::kIdle || candidate.state == State::kQueued;
    });
    if (slot == slots_.end()) return {};
    return {slot->planes[0].address, slot->planes[0].bytes};
}

V4l2Buffers::Slot* V4l2Buffers::FindEmpty() {
    const auto slot = std::ranges::find(slots_, State::kEmpty, &Slot::state);
    return slot == slots_.end() ? nullptr : &*slot;
}

int V4l2Buffers::FindQueued(std::uint32_t driver_index) const {
    const auto slot = std::ranges::find_if(slots_, [&](const Slot& candidate) {
        return candidate.state == State::kQueued && candidate.driver_index == driver_index;
    });
    return slot == slots_.end() ? -1 : static_cast<int>(slot - slots_.begin());
}

V4l2Buffers::Dmabuf V4l2Buffers::FindDmabuf(const std::uint8_t* data) const {
    for (const Slot& slot : slots_) {
        for (const Mapping& plane : slot.planes) {
            if (plane.dmabuf >= 0 && data >= plane.address && data < plane.address + plane.bytes) {
                return {plane.dmabuf, data - plane.address};
            }
        }
    }
    return {};
}

}  // namespace hitchview::drivers
