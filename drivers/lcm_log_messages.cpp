#include "drivers/lcm_log_messages.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <utility>

#include "drivers/lcm_message_bounds.hpp"
#include "drivers/lcm_message_reader.hpp"
#include "lcmtypes/bot_core_image_t.h"
#include "lcmtypes/hitchview_can_frame_t.h"
#include "lcmtypes/hitchview_clock_t.h"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"
#include "lcmtypes/hitchview_rig_t.h"

namespace hitchview::drivers {
namespace {

using hal::Error;
using hal::Instant;
using hal::Result;

constexpr int kLongestSide_px = 16384;
constexpr int kMostProperties = 64;
constexpr int kMostCameras = 32;
constexpr std::int8_t kWorstQuality = HITCHVIEW_HITCH_ANGLE_T_QUALITY_STALE;
constexpr std::int8_t kBestSeam = HITCHVIEW_PANORAMA_STATUS_T_SEAM_LOCKED;

template <typename Int>
std::optional<Int> Number(std::string_view text) {
    Int value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (error != std::errc{} || end != last) return std::nullopt;
    return value;
}

std::optional<Instant> InstantOf(std::string_view text) {
    const auto ns = Number<std::int64_t>(text);
    return ns && IsInstant(Instant(*ns)) ? std::optional(Instant(*ns)) : std::nullopt;
}

void TakeProperty(LcmMessageReader& reader, LoggedImage& image) {
    const std::string_view key = reader.TakeString();
    const std::string_view value = reader.TakeText(reader.Take<std::int32_t>());
    if (key == "sequence") image.sequence = Number<std::uint32_t>(value);
    if (key == "captured_ns" || key == "captured_from_ns") image.captured_at = InstantOf(value);
    if (key == "range" && value == "limited") image.range = hal::Range::kLimited;
}

bool TakeProperties(LcmMessageReader& reader, LoggedImage& image) {
    const auto count = reader.Take<std::int32_t>();
    if (count < 0 || count > kMostProperties) return false;
    for (int i = 0; i < count && reader.ok(); ++i) TakeProperty(reader, image);
    return reader.at_end();
}

bool IsSide(int side_px) {
    return side_px >= 1 && side_px <= kLongestSide_px;
}

template <typename T>
bool IsUpTo(T value, T largest) {
    return value >= 0 && value <= largest;
}

bool HasSoundId(const hal::CanFrame& frame) {
    constexpr std::uint32_t kStandard = 0x7FF;
    constexpr std::uint32_t kExtended = 0x1FFFFFFF;
    const bool longer = frame.extended || frame.kind == hal::CanFrameKind::kError;
    return frame.id <= (longer ? kExtended : kStandard);
}

/// Whether a CAN frame of the message can have been on a bus.
bool IsSound(const hal::CanFrame& frame, std::size_t data_bytes) {
    const std::size_t largest = frame.fd ? 64 : 8;
    const bool remote = frame.kind == hal::CanFrameKind::kRemote;
    return frame.kind <= hal::CanFrameKind::kError && HasSoundId(frame) && frame.fd_flags <= 15 &&
           frame.size_bytes <= largest && data_bytes == (remote ? 0 : frame.size_bytes);
}

hal::CanFrame TakeCanFrame(LcmMessageReader& reader) {
    hal::CanFrame frame;
    frame.id = static_cast<std::uint32_t>(reader.Take<std::int32_t>());
    frame.extended = reader.Take<std::int8_t>() != 0;
    frame.kind = static_cast<hal::CanFrameKind>(reader.Take<std::uint8_t>());
    frame.fd = reader.Take<std::int8_t>() != 0;
    frame.fd_flags = reader.Take<std::uint8_t>();
    frame.size_bytes = reader.Take<std::uint8_t>();
    return frame;
}

bool TakeSeams(LcmMessageReader& reader, hal::PanoramaStatus& status) {
    bool sound = true;
    for (hal::SeamState& seam : status.seams) {
        const auto state = reader.Take<std::int8_t>();
        sound = sound && IsUpTo(state, kBestSeam);
        seam = static_cast<hal::SeamState>(state);
    }
    return sound;
}

std::vector<std::string_view> TakeStrings(LcmMessageReader& reader, int count) {
    std::vector<std::string_view> texts(static_cast<std::size_t>(count));
    std::ranges::generate(texts, [&] { return reader.TakeString(); });
    return texts;
}

}  // namespace

LoggedKind KindOf(std::span<const std::uint8_t> message) {
    const std::array<std::pair<std::int64_t, LoggedKind>, 7> kinds{{
        {__bot_core_image_t_get_hash(), LoggedKind::kImage},
        {__hitchview_can_frame_t_get_hash(), LoggedKind::kCanFrame},
        {__hitchview_hitch_angle_t_get_hash(), LoggedKind::kHitchAngle},
        {__hitchview_panorama_status_t_get_hash(), LoggedKind::kStatus},
        {__hitchview_clock_t_get_hash(), LoggedKind::kClock},
        {__hitchview_event_t_get_hash(), LoggedKind::kEvent},
        {__hitchview_rig_t_get_hash(), LoggedKind::kRig},
    }};
    const auto fingerprint = LcmMessageReader(message).Take<std::int64_t>();
    const auto* const kind =
        std::ranges::find(kinds, fingerprint, &std::pair<std::int64_t, LoggedKind>::first);
    return kind == kinds.end() ? LoggedKind::kUnknown : kind->second;
}

Result<LoggedImage> ParseLoggedImage(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __bot_core_image_t_get_hash()) return Error::kCorrupted;
    LoggedImage image;
    image.utime_us = reader.Take<std::int64_t>();
    image.width_px = reader.Take<std::int32_t>();
    image.height_px = reader.Take<std::int32_t>();
    image.row_stride_bytes = reader.Take<std::int32_t>();
    image.fourcc = reader.Take<std::int32_t>();
    image.data = reader.TakeBytes(reader.Take<std::int32_t>());
    const bool sound = TakeProperties(reader, image) && IsEpoch(image.utime_us) &&
                       IsSide(image.width_px) && IsSide(image.height_px) &&
                       image.row_stride_bytes >= 0 && !image.data.empty();
    if (!sound) return Error::kCorrupted;
    return image;
}

Result<LoggedCanFrame> ParseLoggedCanFrame(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_can_frame_t_get_hash()) return Error::kCorrupted;
    const auto utime_us = reader.Take<std::int64_t>();
    const Instant received_at(reader.Take<std::int64_t>());
    const std::string_view bus = reader.TakeString();
    hal::CanFrame frame = TakeCanFrame(reader);
    const auto data = reader.TakeBytes(reader.Take<std::int8_t>());
    const bool sound = reader.at_end() && IsSound(frame, data.size()) && IsEpoch(utime_us) &&
                       IsInstant(received_at);
    if (!sound) return Error::kCorrupted;
    frame.received_at = received_at;
    frame.epoch = std::chrono::microseconds(utime_us);
    std::ranges::copy(data, frame.data.begin());
    return LoggedCanFrame{bus, frame};
}

Result<LoggedHitchAngle> ParseLoggedHitchAngle(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_hitch_angle_t_get_hash())
        return Error::kCorrupted;
    LoggedHitchAngle logged;
    logged.sequence = reader.Take<std::uint32_t>();
    logged.utime_us = reader.Take<std::int64_t>();
    logged.angle.received_at = Instant(reader.Take<std::int64_t>());
    reader.Take<std::int8_t>();  // valid: the quality says it too
    const auto quality = reader.Take<std::int8_t>();
    logged.angle.quality = static_cast<hal::HitchAngleQuality>(quality);
    logged.angle.angle_rad = reader.TakeDouble();
    const bool sound = reader.at_end() && IsEpoch(logged.utime_us) &&
                       IsInstant(logged.angle.received_at) && IsUpTo(quality, kWorstQuality) &&
                       (quality != 0 || std::isfinite(logged.angle.angle_rad));
    if (!sound) return Error::kCorrupted;
    return logged;
}

Result<LoggedStatus> ParseLoggedStatus(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_panorama_status_t_get_hash())
        return Error::kCorrupted;
    LoggedStatus logged;
    hal::PanoramaStatus& status = logged.status;
    status.sequence = reader.Take<std::uint32_t>();
    logged.utime_us = reader.Take<std::int64_t>();
    status.captured_from = Instant(reader.Take<std::int64_t>());
    status.published_at = Instant(reader.Take<std::int64_t>());
    status.spread = Instant(reader.Take<std::int64_t>());
    status.cameras_missing = reader.Take<std::uint32_t>();
    const bool seams = TakeSeams(reader, status);
    for (int& matches : status.seam_matches) matches = reader.Take<std::int32_t>();
    for (int& features : status.unit_features) features = reader.Take<std::int32_t>();
    status.total_ms = reader.TakeDouble();
    status.deadline_misses = reader.Take<std::uint64_t>();
    status.dropped = reader.Take<std::uint64_t>();
    status.articulation_rad = reader.TakeDouble();
    status.articulation_sigma_rad = reader.TakeDouble();
    const bool timed = IsEpoch(logged.utime_us) && IsInstant(status.captured_from) &&
                       IsInstant(status.published_at);
    if (!reader.at_end() || !seams || !timed) return Error::kCorrupted;
    return logged;
}

Result<LoggedClock> ParseLoggedClock(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_clock_t_get_hash()) return Error::kCorrupted;
    LoggedClock logged;
    logged.utime_us = reader.Take<std::int64_t>();
    logged.monotonic = Instant(reader.Take<std::int64_t>());
    const bool timed = IsEpoch(logged.utime_us) && IsInstant(logged.monotonic);
    if (!reader.at_end() || !timed) return Error::kCorrupted;
    return logged;
}

Result<LoggedEvent> ParseLoggedEvent(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_event_t_get_hash()) return Error::kCorrupted;
    LoggedEvent logged;
    logged.sequence = reader.Take<std::uint32_t>();
    logged.utime_us = reader.Take<std::int64_t>();
    reader.Take<std::int64_t>();  // monotonic_ns
    logged.code = reader.Take<std::int16_t>();
    logged.subject = reader.TakeString();
    logged.text = reader.TakeString();
    if (!reader.at_end() || !IsEpoch(logged.utime_us)) return Error::kCorrupted;
    return logged;
}

Result<LoggedRig> ParseLoggedRig(std::span<const std::uint8_t> message) {
    LcmMessageReader reader(message);
    if (reader.Take<std::int64_t>() != __hitchview_rig_t_get_hash()) return Error::kCorrupted;
    LoggedRig logged;
    logged.utime_us = reader.Take<std::int64_t>();
    logged.rig_yaml = reader.TakeString();
    logged.calibration_yaml = reader.TakeString();
    logged.calibration_id = reader.TakeString();
    const auto cameras = reader.Take<std::int32_t>();
    if (!IsUpTo(cameras, kMostCameras)) return Error::kCorrupted;
    logged.cameras = TakeStrings(reader, cameras);
    logged.camera_channels = TakeStrings(reader, cameras);
    logged.period_ms = reader.TakeDouble();
    const bool sound = reader.at_end() && IsEpoch(logged.utime_us) &&
                       std::isfinite(logged.period_ms) && logged.period_ms > 0;
    if (!sound) return Error::kCorrupted;
    return logged;
}

}  // namespace hitchview::drivers
