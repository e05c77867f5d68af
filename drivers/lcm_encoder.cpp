#include "drivers/lcm_encoder.hpp"

#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "drivers/lcm_health_message.hpp"
#include "drivers/lcm_image_properties.hpp"
#include "drivers/lcm_url.hpp"
#include "lcmtypes/bot_core_image_t.h"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_health_t.h"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "lcmtypes/hitchview_overlay_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"

namespace hitchview::drivers {
namespace {

using hal::Checked;
using hal::Done;
using hal::Error;
using hal::Result;

constexpr int kSmallestImageBytes = 1024;
constexpr int kLargestImageBytes = 8 << 20;
static_assert(int(hal::SeamState::kNoOverlap) == HITCHVIEW_PANORAMA_STATUS_T_SEAM_NO_OVERLAP);
static_assert(int(hal::SeamState::kReacquire) == HITCHVIEW_PANORAMA_STATUS_T_SEAM_REACQUIRE);
static_assert(int(hal::SeamState::kCoast) == HITCHVIEW_PANORAMA_STATUS_T_SEAM_COAST);
static_assert(int(hal::SeamState::kLocked) == HITCHVIEW_PANORAMA_STATUS_T_SEAM_LOCKED);
using Quality = hal::HitchAngleQuality;
static_assert(int(Quality::kValid) == HITCHVIEW_HITCH_ANGLE_T_QUALITY_VALID);
static_assert(int(Quality::kNotAvailable) == HITCHVIEW_HITCH_ANGLE_T_QUALITY_NOT_AVAILABLE);
static_assert(int(Quality::kError) == HITCHVIEW_HITCH_ANGLE_T_QUALITY_ERROR);
static_assert(int(Quality::kImplausible) == HITCHVIEW_HITCH_ANGLE_T_QUALITY_IMPLAUSIBLE);
static_assert(int(Quality::kStale) == HITCHVIEW_HITCH_ANGLE_T_QUALITY_STALE);
using Code = hal::EventCode;
static_assert(int(Code::kCameraLost) == HITCHVIEW_EVENT_T_CAMERA_LOST);
static_assert(int(Code::kCameraBack) == HITCHVIEW_EVENT_T_CAMERA_BACK);
static_assert(int(Code::kCameraLate) == HITCHVIEW_EVENT_T_CAMERA_LATE);
static_assert(int(Code::kCameraDisordered) == HITCHVIEW_EVENT_T_CAMERA_DISORDERED);
static_assert(int(Code::kCameraBlack) == HITCHVIEW_EVENT_T_CAMERA_BLACK);
static_assert(int(Code::kCameraBlinded) == HITCHVIEW_EVENT_T_CAMERA_BLINDED);
static_assert(int(Code::kCameraFrozen) == HITCHVIEW_EVENT_T_CAMERA_FROZEN);
static_assert(int(Code::kCameraStuck) == HITCHVIEW_EVENT_T_CAMERA_STUCK);
static_assert(int(Code::kCameraBlurred) == HITCHVIEW_EVENT_T_CAMERA_BLURRED);
static_assert(int(Code::kCameraDirty) == HITCHVIEW_EVENT_T_CAMERA_DIRTY);
static_assert(int(Code::kSeamLocked) == HITCHVIEW_EVENT_T_SEAM_LOCKED);
static_assert(int(Code::kSeamCoast) == HITCHVIEW_EVENT_T_SEAM_COAST);
static_assert(int(Code::kSeamReacquire) == HITCHVIEW_EVENT_T_SEAM_REACQUIRE);
static_assert(int(Code::kSeamNoOverlap) == HITCHVIEW_EVENT_T_SEAM_NO_OVERLAP);
static_assert(int(Code::kCalibrationMismatch) == HITCHVIEW_EVENT_T_CALIBRATION_MISMATCH);
static_assert(int(Code::kDeadlineMissed) == HITCHVIEW_EVENT_T_DEADLINE_MISSED);
static_assert(int(Code::kDeadlineKept) == HITCHVIEW_EVENT_T_DEADLINE_KEPT);
static_assert(int(Code::kPanoramasDropped) == HITCHVIEW_EVENT_T_PANORAMAS_DROPPED);
static_assert(int(Code::kReceiveBufferSmall) == HITCHVIEW_EVENT_T_RECEIVE_BUFFER_SMALL);
static_assert(int(Code::kRecordingStarted) == HITCHVIEW_EVENT_T_RECORDING_STARTED);
static_assert(int(Code::kRecordingStopped) == HITCHVIEW_EVENT_T_RECORDING_STOPPED);
static_assert(int(Code::kRecordingFailed) == HITCHVIEW_EVENT_T_RECORDING_FAILED);
static_assert(int(Code::kRecordingDropped) == HITCHVIEW_EVENT_T_RECORDING_DROPPED);

/// Room for everything in an image message that is not its JPEG.
constexpr int kEnvelopeBytes = 1024;
/// Of what is no image: an overlay of a canvas of 4096 rows.
constexpr int kLargestOtherBytes = 32768;

Checked<Done> Check(const LcmEncoderOptions& options) {
    const std::pair<const char*, const std::string&> channels[] = {
        {"panorama_channel", options.panorama_channel},
        {"status_channel", options.status_channel},
        {"hitch_angle_channel", options.hitch_angle_channel},
        {"event_channel", options.event_channel},
        {"health_channel", options.health_channel},
        {"overlay_channel", options.overlay_channel}};
    for (const auto& [key, channel] : channels) {
        if (auto name = CheckLcmChannel(key, channel); !name) return name;
    }
    const int bytes = options.max_image_bytes;
    if (bytes >= kSmallestImageBytes && bytes <= kLargestImageBytes) return Done{};
    return "max_image_bytes is " + std::to_string(bytes) + ", must be " +
           std::to_string(kSmallestImageBytes) + " to " + std::to_string(kLargestImageBytes);
}

}  // namespace

Checked<std::unique_ptr<LcmEncoder>> LcmEncoder::Create(const LcmEncoderOptions& options,
                                                        const hal::Clock& clock) {
    if (auto checked = Check(options); !checked) return checked.error();
    return std::unique_ptr<LcmEncoder>(new LcmEncoder(options, clock));
}

LcmEncoder::LcmEncoder(const LcmEncoderOptions& options, const hal::Clock& clock)
    : options_(options),
      clock_(clock),
      buffer_(static_cast<std::size_t>(options.max_image_bytes) + kEnvelopeBytes),
      other_buffer_(kLargestOtherBytes) {}

template <typename Message>
Result<LcmMessage> LcmEncoder::Write(const char* channel, const Message& message,
                                     int (*encode)(void*, int, int, const Message*)) {
    constexpr bool kIsImage = std::is_same_v<Message, bot_core_image_t>;
    std::vector<std::uint8_t>& buffer = kIsImage ? buffer_ : other_buffer_;
    const int bytes = encode(buffer.data(), 0, static_cast<int>(buffer.size()), &message);
    if (bytes < 0) return Error::kTooLarge;
    return LcmMessage{.channel = channel,
                      .utime_us = message.utime,
                      .bytes = {buffer.data(), static_cast<std::size_t>(bytes)}};
}

Result<LcmMessage> LcmEncoder::Encode(const hal::PanoramaImage& image) {
    LcmImageProperties properties(image);
    return EncodeImage(options_.panorama_channel.c_str(), image, properties);
}

Result<LcmMessage> LcmEncoder::Encode(const hal::ViewportImage& viewport) {
    LcmImageProperties properties(viewport.image);
    return EncodeImage(viewport.channel, viewport.image, properties);
}

Result<LcmMessage> LcmEncoder::Encode(const hal::PreviewImage& preview) {
    LcmImageProperties properties(preview);
    return EncodeImage(preview.channel,
                       {.captured_from = preview.captured_at,
                        .width_px = preview.width_px,
                        .height_px = preview.height_px,
                        .jpeg = preview.jpeg},
                       properties);
}

Result<LcmMessage> LcmEncoder::EncodeImage(const char* channel, const hal::PanoramaImage& image,
                                           LcmImageProperties& properties) {
    const auto limit = static_cast<std::size_t>(options_.max_image_bytes);
    if (image.jpeg.size() > limit) return Error::kTooLarge;
    const bot_core_image_t message{
        .utime = clock_.EpochMicroseconds(image.captured_from),
        .width = image.width_px,
        .height = image.height_px,
        .row_stride = 0,
        .pixelformat = BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG,
        .size = static_cast<std::int32_t>(image.jpeg.size()),
        .data = const_cast<std::uint8_t*>(image.jpeg.data()),
        .nmetadata = static_cast<std::int32_t>(properties.entries().size()),
        .metadata = properties.entries().data(),
    };
    return Write(channel, message, bot_core_image_t_encode);
}

Result<LcmMessage> LcmEncoder::Encode(const hal::PanoramaStatus& status) {
    hitchview_panorama_status_t message{
        .sequence = static_cast<std::int32_t>(status.sequence),
        .utime = clock_.EpochMicroseconds(status.captured_from),
        .capture_ns = status.captured_from.count(),
        .publish_ns = status.published_at.count(),
        .spread_ns = status.spread.count(),
        .cameras_missing = static_cast<std::int32_t>(status.cameras_missing),
        .seam_state = {},
        .seam_matches = {status.seam_matches[0], status.seam_matches[1]},
        .unit_features = {status.unit_features[0], status.unit_features[1]},
        .total_ms = status.total_ms,
        .deadline_misses = static_cast<std::int64_t>(status.deadline_misses),
        .dropped = static_cast<std::int64_t>(status.dropped),
        .articulation_rad = status.articulation_rad,
        .articulation_sigma_rad = status.articulation_sigma_rad,
    };
    message.seam_state[0] = static_cast<std::int8_t>(status.seams[0]);
    message.seam_state[1] = static_cast<std::int8_t>(status.seams[1]);
    return Write(options_.status_channel.c_str(), message, hitchview_panorama_status_t_encode);
}

Result<LcmMessage> LcmEncoder::Encode(const hal::HitchAngle& angle) {
    // A reader who ignores the quality must not find a plausible angle.
    constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
    const bool valid = angle.quality == hal::HitchAngleQuality::kValid;
    const hitchview_hitch_angle_t message{
        .sequence = static_cast<std::int32_t>(hitch_angle_sequence_++),
        .utime = clock_.EpochMicroseconds(angle.received_at),
        .capture_ns = angle.received_at.count(),
        .valid = valid,
        .quality = static_cast<std::int8_t>(angle.quality),
        .angle_rad = valid ? angle.angle_rad : kNotANumber,
    };
    return Write(options_.hitch_angle_channel.c_str(), message, hitchview_hitch_angle_t_encode);
}

Result<LcmMessage> LcmEncoder::Encode(const hal::Event& event) {
    // The generated type has no const members; encoding only reads them.
    const hitchview_event_t message{
        .sequence = static_cast<std::int32_t>(event_sequence_++),
        .utime = clock_.EpochMicroseconds(event.when),
        .monotonic_ns = event.when.count(),
        .code = static_cast<std::int16_t>(event.code),
        .subject = const_cast<char*>(event.subject.c_str()),
        .text = const_cast<char*>(event.text.c_str()),
    };
    return Write(options_.event_channel.c_str(), message, hitchview_event_t_encode);
}

Result<LcmMessage> LcmEncoder::Encode(const hal::Health& health) {
    const LcmHealthMessage message(health, health_sequence_++,
                                   clock_.EpochMicroseconds(health.measured_at));
    return Write(options_.health_channel.c_str(), message.get(), hitchview_health_t_encode);
}

Result<LcmMessage> LcmEncoder::Encode(const hal::Overlay& overlay) {
    // The generated type has no const members; encoding only reads them.
    const auto borrow = [](std::span<const float> values) {
        return const_cast<float*>(values.data());
    };
    const hitchview_overlay_t message{
        .sequence = static_cast<std::int32_t>(overlay.sequence),
        .utime = clock_.EpochMicroseconds(overlay.captured_from),
        .capture_ns = overlay.captured_from.count(),
        .width = overlay.width_px,
        .height = overlay.height_px,
        .mesh_rows = overlay.mesh_rows,
        .mesh_cols = overlay.mesh_cols,
        .nvertices = static_cast<std::int32_t>(overlay.mesh_x.size()),
        .mesh_x = borrow(overlay.mesh_x),
        .mesh_y = borrow(overlay.mesh_y),
        .seam_rows = static_cast<std::int32_t>(overlay.seam_y.size()),
        .seam_y = borrow(overlay.seam_y),
        .left_seam_x = borrow(overlay.left_seam_x),
        .right_seam_x = borrow(overlay.right_seam_x),
    };
    return Write(options_.overlay_channel.c_str(), message, hitchview_overlay_t_encode);
}

}  // namespace hitchview::drivers
