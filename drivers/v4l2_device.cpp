#include "drivers/v4l2_device.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>

namespace hitchview::drivers {
namespace {

hal::Error MeaningOfIoctl(int error_number) {
    switch (error_number) {
        case EAGAIN:
            return hal::Error::kTimeout;
        case ENODEV:
        case ENXIO:
        case EIO:
        case EPIPE:
            return hal::Error::kDisconnected;
        case ENOTTY:
            return hal::Error::kUnsupported;
        default:
            return hal::Error::kFailed;
    }
}

hal::Error MeaningOfOpen(int error_number) {
    const bool absent = error_number == ENOENT || error_number == ENODEV || error_number == ENXIO ||
                        error_number == ENOTDIR;
    return absent ? hal::Error::kNotFound : hal::Error::kFailed;
}

template <std::size_t kTo, std::size_t kFrom>
void CopyField(const __u8 (&from)[kFrom], std::array<char, kTo>& to) {
    static_assert(kTo == kFrom);
    std::ranges::transform(from, to.begin(), [](__u8 letter) { return static_cast<char>(letter); });
}

}  // namespace

V4l2Result<hal::Done> V4l2Device::Open(const char* path) {
    Close();
    file_ = kernel_->Open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) return V4l2Failure{MeaningOfOpen(errno), "open", errno};
    const auto identified = Identify();
    if (!identified) Close();
    return identified;
}

void V4l2Device::Close() {
    if (file_ >= 0) kernel_->Close(file_);
    file_ = -1;
}

V4l2Result<hal::Done> V4l2Device::Identify() {
    v4l2_capability capability{};
    if (const auto asked = Call(VIDIOC_QUERYCAP, "VIDIOC_QUERYCAP", capability); !asked)
        return asked.error();
    CopyField(capability.driver, identity_.driver);
    CopyField(capability.card, identity_.card);
    CopyField(capability.bus_info, identity_.bus);
    const std::uint32_t abilities = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                        ? capability.device_caps
                                        : capability.capabilities;
    multi_planar_ = (abilities & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
    const bool captures = multi_planar_ || (abilities & V4L2_CAP_VIDEO_CAPTURE) != 0;
    if (!captures) return V4l2Failure{hal::Error::kUnsupported, "it does not capture video", 0};
    if ((abilities & V4L2_CAP_STREAMING) == 0) {
        return V4l2Failure{hal::Error::kUnsupported, "it does not stream into mapped buffers", 0};
    }
    return hal::Done{};
}

std::uint32_t V4l2Device::buffer_type() const {
    return multi_planar_ ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

V4l2Result<hal::Done> V4l2Device::Outcome(int answer, const char* name) {
    if (answer >= 0) return hal::Done{};
    return V4l2Failure{MeaningOfIoctl(errno), name, errno};
}

std::string FieldText(std::span<const char> field) {
    return {field.begin(), std::ranges::find(field, '\0')};
}

}  // namespace hitchview::drivers
