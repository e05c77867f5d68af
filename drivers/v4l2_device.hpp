#pragma once

#include <linux/videodev2.h>

#include <array>
#include <cstdint>
#include <string>

#include "drivers/v4l2_kernel.hpp"

namespace hitchview::drivers {

/// Which device it is, as it says itself (VIDIOC_QUERYCAP). Takes nothing from the heap.
struct V4l2Identity {
    std::array<char, 16> driver{};
    std::array<char, 32> card{};
    std::array<char, 32> bus{};  ///< where it is plugged in: usb-0000:00:14.0-2

    friend bool operator==(const V4l2Identity&, const V4l2Identity&) = default;
};

/// One video node, open or not: its handle, what kind of node it is, its ioctls with errno turned
/// into an outcome. No ioctl but VIDIOC_QUERYCAP of its own. Takes nothing from the heap. Thread:
/// one at a time.
class V4l2Device {
 public:
    explicit V4l2Device(V4l2Kernel& kernel) : kernel_(&kernel) {}
    ~V4l2Device() { Close(); }
    V4l2Device(const V4l2Device&) = delete;
    V4l2Device& operator=(const V4l2Device&) = delete;

    /// Not blocking. kNotFound: nothing is there; kUnsupported: it is no camera that streams.
    V4l2Result<hal::Done> Open(const char* path);
    void Close();
    [[nodiscard]] int file() const { return file_; }
    [[nodiscard]] V4l2Kernel& kernel() const { return *kernel_; }

    [[nodiscard]] const V4l2Identity& identity() const { return identity_; }
    [[nodiscard]] bool multi_planar() const { return multi_planar_; }
    /// V4L2_BUF_TYPE_VIDEO_CAPTURE or ..._MPLANE.
    [[nodiscard]] std::uint32_t buffer_type() const;

    /// `name`: of the request, static. kDisconnected: ENODEV, EIO, EPIPE, ENXIO; kTimeout: EAGAIN;
    /// kUnsupported: ENOTTY, the device has no such ioctl; otherwise kFailed.
    template <typename T>
    V4l2Result<hal::Done> Call(unsigned long request, const char* name, T& argument) const {
        return Outcome(kernel_->Ioctl(file_, request, &argument), name);
    }

 private:
    static V4l2Result<hal::Done> Outcome(int answer, const char* name);
    V4l2Result<hal::Done> Identify();

    V4l2Kernel* kernel_;
    int file_ = -1;
    V4l2Identity identity_;
    bool multi_planar_ = false;
};

/// Text of a fixed field of the kernel's, which may lack its end.
std::string FieldText(std::span<const char> field);

}  // namespace hitchview::drivers
