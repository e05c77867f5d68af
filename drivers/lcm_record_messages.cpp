#include "drivers/lcm_record_messages.hpp"

#include <array>
#include <charconv>
#include <string_view>

#include "hal/expect.hpp"
#include "lcmtypes/bot_core_image_t.h"
#include "lcmtypes/hitchview_can_frame_t.h"
#include "lcmtypes/hitchview_clock_t.h"
#include "lcmtypes/hitchview_rig_t.h"

namespace hitchview::drivers {
namespace {

static_assert(int(hal::CanFrameKind::kData) == HITCHVIEW_CAN_FRAME_T_KIND_DATA);
static_assert(int(hal::CanFrameKind::kRemote) == HITCHVIEW_CAN_FRAME_T_KIND_REMOTE);
static_assert(int(hal::CanFrameKind::kError) == HITCHVIEW_CAN_FRAME_T_KIND_ERROR);

/// Everything in a picture's message that is not its data.
constexpr std::size_t kEnvelopeBytes = 256;

template <typename Message>
std::size_t Write(const Message& message, int (*encode)(void*, int, int, const Message*),
                  std::span<std::uint8_t> out) {
    const int bytes = encode(out.data(), 0, static_cast<int>(out.size()), &message);
    return bytes < 0 ? 0 : static_cast<std::size_t>(bytes);
}

// The generated types have no const members; encoding only reads them.
std::uint8_t* Unconst(const std::uint8_t* bytes) {
    return const_cast<std::uint8_t*>(bytes);
}
char* Unconst(const char* text) {
    return const_cast<char*>(text);
}

using Digits = std::array<char, 24>;

std::string_view Text(std::int64_t number, Digits& digits) {
    const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    return {digits.data(), static_cast<std::size_t>(end - digits.data())};
}

bot_core_image_metadata_t Property(const char* key, std::string_view value) {
    return {.key = Unconst(key),
            .n = static_cast<std::int32_t>(value.size()),
            .value = Unconst(reinterpret_cast<const std::uint8_t*>(value.data()))};
}

std::int32_t FourccOf(const CameraPicture& picture) {
    if (picture.compressed) return BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG;
    switch (picture.format.pixel_format) {
        case hal::PixelFormat::kNv12:
            return BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12;
        case hal::PixelFormat::kUyvy:
            return BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY;
        case hal::PixelFormat::kYuyv:
            return BOT_CORE_IMAGE_T_PIXEL_FORMAT_YUYV;
        case hal::PixelFormat::kGrey:
            return BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY;
        case hal::PixelFormat::kI420:
            break;
    }
    HV_EXPECT(picture.format.pixel_format != hal::PixelFormat::kI420);
    return 0;
}

std::vector<char*> Pointers(const std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (const std::string& text : texts) pointers.push_back(Unconst(text.c_str()));
    return pointers;
}

}  // namespace

std::size_t MostBytesOf(const CameraPicture& picture) {
    return picture.data.size() + kEnvelopeBytes;
}

std::size_t Encode(const CameraPicture& picture, std::span<std::uint8_t> out) {
    const hal::FrameFormat& format = picture.format;
    Digits sequence;
    Digits captured;
    std::array metadata{Property("sequence", Text(picture.sequence, sequence)),
                        Property("captured_ns", Text(picture.captured_at.count(), captured)),
                        Property("range", format.range == hal::Range::kFull ? "full" : "limited")};
    const int stride = hal::PackedPlanes(format, picture.data.data())[0].stride_bytes;
    const bot_core_image_t message{.utime = picture.utime_us,
                                   .width = format.width_px,
                                   .height = format.height_px,
                                   .row_stride = picture.compressed ? 0 : stride,
                                   .pixelformat = FourccOf(picture),
                                   .size = static_cast<std::int32_t>(picture.data.size()),
                                   .data = Unconst(picture.data.data()),
                                   .nmetadata = static_cast<std::int32_t>(metadata.size()),
                                   .metadata = metadata.data()};
    return Write(message, bot_core_image_t_encode, out);
}

std::size_t Encode(const hal::CanFrame& frame, std::int64_t utime_us, const char* bus,
                   std::span<std::uint8_t> out) {
    const bool remote = frame.kind == hal::CanFrameKind::kRemote;
    const hitchview_can_frame_t message{
        .utime = utime_us,
        .capture_ns = frame.received_at.count(),
        .bus = Unconst(bus),
        .id = static_cast<std::int32_t>(frame.id),
        .extended = frame.extended,
        .kind = static_cast<std::int8_t>(frame.kind),
        .fd = frame.fd,
        .fd_flags = static_cast<std::int8_t>(frame.fd_flags),
        .size = static_cast<std::int8_t>(frame.size_bytes),
        .ndata = static_cast<std::int8_t>(remote ? 0 : frame.size_bytes),
        .data = Unconst(frame.data.data())};
    return Write(message, hitchview_can_frame_t_encode, out);
}

std::size_t EncodeClock(std::int64_t utime_us, hal::Instant monotonic,
                        std::span<std::uint8_t> out) {
    const hitchview_clock_t message{.utime = utime_us, .monotonic_ns = monotonic.count()};
    return Write(message, hitchview_clock_t_encode, out);
}

RigMessage::RigMessage(const RecordedRig& rig) {
    HV_EXPECT(rig.cameras.size() == rig.camera_channels.size());
    std::vector<char*> cameras = Pointers(rig.cameras);
    std::vector<char*> channels = Pointers(rig.camera_channels);
    const hitchview_rig_t message{.utime = 0,
                                  .rig_yaml = Unconst(rig.rig_yaml.c_str()),
                                  .calibration_yaml = Unconst(rig.calibration_yaml.c_str()),
                                  .calibration_id = Unconst(rig.calibration_id.c_str()),
                                  .ncameras = static_cast<std::int32_t>(cameras.size()),
                                  .camera = cameras.data(),
                                  .camera_channel = channels.data(),
                                  .period_ms = rig.period_ms};
    bytes_.resize(static_cast<std::size_t>(hitchview_rig_t_encoded_size(&message)));
    HV_EXPECT(Write(message, hitchview_rig_t_encode, bytes_) == bytes_.size());
}

std::span<const std::uint8_t> RigMessage::At(std::int64_t utime_us) {
    constexpr std::size_t kFingerprintBytes = 8;  // the time comes right behind it
    auto rest = static_cast<std::uint64_t>(utime_us);
    for (std::size_t i = kFingerprintBytes + 8; i-- > kFingerprintBytes; rest >>= 8)
        bytes_[i] = static_cast<std::uint8_t>(rest);
    return bytes_;
}

}  // namespace hitchview::drivers
