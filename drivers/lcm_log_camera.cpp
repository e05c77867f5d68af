#include "drivers/lcm_log_camera.hpp"

namespace hitchview::drivers {
namespace {

/// More than any message of such a frame needs: a length that is damaged takes no memory.
std::size_t LargestMessage(const hal::FrameFormat& format) {
    constexpr std::size_t kProperties = 64 << 10;
    return 4 * hal::FrameBytes(format) + kProperties;
}

}  // namespace

LcmLogCamera::LcmLogCamera(const LcmLogCameraOptions& options)
    : options_(options), pool_(options.kind.format, options.slots), decoder_(options.kind) {}

LcmLogCamera::~LcmLogCamera() = default;

bool LcmLogCamera::Append(const hal::FrameHeader& header, const LcmLogPlace& place) {
    return wanted_.Append({header, place});
}

hal::Result<hal::FrameLease> LcmLogCamera::DoWaitFrame(std::chrono::milliseconds timeout) {
    const auto slot = pool_.Take();
    if (!slot) return hal::Error::kTimeout;
    const auto wanted = wanted_.TakeFor(timeout);
    const auto fetched =
        wanted ? Fetch(wanted->place, slot->bytes)
               : (wanted_.finished() ? hal::Error::kEndOfStream : hal::Error::kTimeout);
    if (fetched) return pool_.Lease(*slot, wanted->header);
    pool_.Return(*slot);
    return fetched.error();
}

hal::Result<hal::Done> LcmLogCamera::Fetch(const LcmLogPlace& place,
                                           std::span<std::uint8_t> frame) {
    if (place.size_bytes > LargestMessage(pool_.format()) || !Open(place.file))
        return hal::Error::kCorrupted;
    message_.resize(place.size_bytes);
    if (!window_->Copy(place.position_bytes, message_)) return hal::Error::kCorrupted;
    const auto image = ParseLoggedImage(message_);
    if (!image) return image.error();
    return decoder_.Decode(image.value(), frame);
}

bool LcmLogCamera::Open(std::size_t file) {
    if (window_ && open_file_ == file) return true;
    window_.reset();
    if (file >= options_.files.size()) return false;
    auto window = LcmLogWindow::Open(options_.files[file].string());
    if (!window) return false;
    window_ = std::move(*window);
    open_file_ = file;
    return true;
}

}  // namespace hitchview::drivers
