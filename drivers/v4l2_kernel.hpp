#pragma once

#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <span>

#include "hal/result.hpp"

namespace hitchview::drivers {

/// What the kernel refused, without words taken from the heap: `call` has static storage.
struct V4l2Failure {
    hal::Error error = hal::Error::kFailed;
    const char* call = "";
    int error_number = 0;  ///< errno; 0: not the kernel's refusal but ours
};

/// "VIDIOC_STREAMON: Input/output error".
std::string ToString(const V4l2Failure& failure);

template <typename T>
using V4l2Result = hal::Result<T, V4l2Failure>;

/// The system calls that a camera is driven by, so that a test may stand in for the kernel. Each
/// answers as the call of that name does, errno included. Any thread.
class V4l2Kernel {
 public:
    virtual ~V4l2Kernel() = default;

    virtual int Open(const char* path, int flags) = 0;
    virtual int Close(int file) = 0;
    /// Called again after a signal (EINTR).
    virtual int Ioctl(int file, unsigned long request, void* argument) = 0;
    /// A shared mapping that can be read and written; MAP_FAILED if refused.
    virtual void* Map(int file, std::size_t bytes, off_t offset) = 0;
    virtual int Unmap(void* address, std::size_t bytes) = 0;
    /// 0 also after a signal.
    virtual int Poll(std::span<pollfd> files, std::chrono::milliseconds timeout) = 0;
};

/// The real one.
V4l2Kernel& SystemKernel();

}  // namespace hitchview::drivers
