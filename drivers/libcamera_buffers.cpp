#include "drivers/libcamera_buffers.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace hitchview::drivers {

using hal::Checked;
using hal::Done;

LibcameraBuffers::~LibcameraBuffers() {
    Collect(mailbox_.Take({}).returned);
}

Checked<Done> LibcameraBuffers::Take(const std::shared_ptr<libcamera::Camera>& camera,
                                     libcamera::Stream* stream) {
    allocator_ = std::make_unique<libcamera::FrameBufferAllocator>(camera);
    stream_ = stream;
    if (const int got = allocator_->allocate(stream); got < 0)
        return std::string("no buffers: ") + std::strerror(-got);
    for (const auto& buffer : allocator_->buffers(stream)) {
        if (const auto taken = TakeOne(*camera, stream, *buffer); !taken) return taken.error();
    }
    count_ = static_cast<int>(allocator_->buffers(stream).size());
    low_water_ = count_.load();
    return Done{};
}

Checked<Done> LibcameraBuffers::TakeOne(libcamera::Camera& camera, libcamera::Stream* stream,
                                        libcamera::FrameBuffer& buffer) {
    const auto empty = std::ranges::find(slots_, State::kEmpty, &Slot::state);
    if (empty == slots_.end()) return std::string("frames of earlier streams never came back");
    Slot& slot = *empty;
    slot.state = State::kIdle;
    slot.buffer = &buffer;
    slot.request = camera.createRequest(static_cast<std::uint64_t>(empty - slots_.begin()));
    if (slot.request == nullptr || slot.request->addBuffer(stream, &buffer) != 0)
        return std::string("a request is refused");
    const std::size_t planes = std::min(buffer.planes().size(), slot.planes.size());
    for (std::size_t i = 0; i < planes; ++i) {
        const auto mapping = Map(buffer.planes()[i]);
        if (!mapping) return mapping.error();
        slot.planes[i] = mapping.value();
    }
    return Done{};
}

Checked<LibcameraBuffers::Mapping> LibcameraBuffers::Map(
    const libcamera::FrameBuffer::Plane& plane) {
    // mmap starts at whole pages only; a plane may start within one.
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t lead = plane.offset % page;
    Mapping mapping;
    mapping.bytes = plane.length + lead;
    mapping.address = mmap(nullptr, mapping.bytes, PROT_READ, MAP_SHARED, plane.fd.get(),
                           static_cast<off_t>(plane.offset - lead));
    if (mapping.address == MAP_FAILED)
        return std::string("a buffer cannot be mapped: ") + std::strerror(errno);
    mapping.plane = {static_cast<const std::uint8_t*>(mapping.address) + lead, plane.length};
    return mapping;
}

void LibcameraBuffers::Unmap(Slot& slot) {
    for (const Mapping& mapping : slot.planes) {
        if (mapping.address != nullptr) munmap(mapping.address, mapping.bytes);
    }
    slot = {};
}

void LibcameraBuffers::Drop() {
    for (Slot& slot : slots_) {
        slot.request.reset();
        slot.buffer = nullptr;
        if (slot.state == State::kIdle || slot.state == State::kQueued) Unmap(slot);
        if (slot.state == State::kLent) slot.state = State::kOrphaned;
    }
    lent_ = 0;
    if (allocator_ != nullptr) allocator_->free(stream_);
    allocator_.reset();
}

void LibcameraBuffers::Collect(std::uint64_t returned) {
    for (int i = 0; returned != 0; ++i, returned >>= 1) {
        if ((returned & 1) == 0) continue;
        Slot& slot = At(i);
        if (slot.state == State::kOrphaned) {
            Unmap(slot);
        } else {
            slot.state = State::kIdle;
            --lent_;
        }
    }
}

int LibcameraBuffers::Queue(libcamera::Camera& camera, const libcamera::ControlList* controls) {
    int refused = 0;
    for (Slot& slot : slots_) {
        if (slot.state != State::kIdle) continue;
        if (std::exchange(slot.used, true)) {
            slot.request->reuse(libcamera::Request::ReuseBuffers);
        } else if (controls != nullptr && !controls->empty()) {
            slot.request->controls().merge(*std::exchange(controls, nullptr));
        }
        // Before the call: it may be filled before the call is over.
        slot.state = State::kQueued;
        if (const int answer = camera.queueRequest(slot.request.get()); answer != 0) {
            slot.state = State::kIdle;
            refused = answer;
        }
    }
    return refused;
}

hal::FrameLease LibcameraBuffers::Lend(int slot, const hal::FrameView& view) {
    At(slot).state = State::kLent;
    ++lent_;
    low_water_ = std::min(low_water_.load(), count_ - lent_);
    return {*this, slot, view};
}

LibcameraPlanes LibcameraBuffers::memory(int slot) {
    LibcameraPlanes memory;
    for (std::size_t i = 0; i < memory.size(); ++i) memory[i] = At(slot).planes[i].plane;
    return memory;
}

}  // namespace hitchview::drivers
