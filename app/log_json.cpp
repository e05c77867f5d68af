#include "app/log_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "app/log_time.hpp"
#include "app/mcap_schemas.hpp"

namespace hitchview::app {
namespace {

using drivers::LoggedKind;
using nlohmann::json;

json Degrees(double rad) {
    return std::isfinite(rad) ? json(rad * 180 / std::numbers::pi) : json();
}

std::optional<LogJson> Status(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedStatus(message);
    if (!logged) return std::nullopt;
    const hal::PanoramaStatus& s = logged.value().status;
    return LogJson{s.sequence,
                   {{"sequence", s.sequence},
                    {"capture_ns", s.captured_from.count()},
                    {"latency_ms", Milliseconds(s.published_at - s.captured_from)},
                    {"spread_ms", Milliseconds(s.spread)},
                    {"cameras_missing", s.cameras_missing},
                    {"seam_left", ToString(s.seams[0])},
                    {"seam_right", ToString(s.seams[1])},
                    {"seam_matches_left", s.seam_matches[0]},
                    {"seam_matches_right", s.seam_matches[1]},
                    {"features_tractor", s.unit_features[0]},
                    {"features_trailer", s.unit_features[1]},
                    {"total_ms", s.total_ms},
                    {"deadline_misses", s.deadline_misses},
                    {"dropped", s.dropped},
                    {"articulation_deg", Degrees(s.articulation_rad)},
                    {"articulation_sigma_deg", Degrees(s.articulation_sigma_rad)}}};
}

std::optional<LogJson> HitchAngle(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedHitchAngle(message);
    if (!logged) return std::nullopt;
    const hal::HitchAngle& angle = logged.value().angle;
    const bool valid = angle.quality == hal::HitchAngleQuality::kValid;
    return LogJson{logged.value().sequence,
                   {{"sequence", logged.value().sequence},
                    {"quality", static_cast<int>(angle.quality)},
                    {"angle_deg", valid ? Degrees(angle.angle_rad) : json()}}};
}

std::string Hex(std::span<const std::uint8_t> bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += "0123456789ABCDEF"[byte >> 4];
        text += "0123456789ABCDEF"[byte & 15];
    }
    return text;
}

std::optional<LogJson> CanFrame(std::span<const std::uint8_t> message) {
    constexpr std::array<const char*, 3> kKinds{"data", "remote", "error"};
    const auto logged = drivers::ParseLoggedCanFrame(message);
    if (!logged) return std::nullopt;
    const hal::CanFrame& frame = logged.value().frame;
    const bool remote = frame.kind == hal::CanFrameKind::kRemote;
    const auto data = std::span(frame.data).first(remote ? 0U : frame.size_bytes);
    return LogJson{0,
                   {{"bus", logged.value().bus},
                    {"id", frame.id},
                    {"extended", frame.extended},
                    {"kind", kKinds.at(static_cast<std::size_t>(frame.kind))},
                    {"fd", frame.fd},
                    {"size", frame.size_bytes},
                    {"data", Hex(data)}}};
}

std::optional<LogJson> LogEntry(std::span<const std::uint8_t> message) {
    constexpr std::int64_t kMicroseconds = 1'000'000;
    constexpr int kInfo = 2;
    const auto logged = drivers::ParseLoggedEvent(message);
    if (!logged) return std::nullopt;
    const drivers::LoggedEvent& event = logged.value();
    return LogJson{event.sequence,
                   {{"timestamp",
                     {{"sec", event.utime_us / kMicroseconds},
                      {"nsec", event.utime_us % kMicroseconds * 1000}}},
                    {"level", kInfo},
                    {"name", event.subject},
                    {"message", event.text},
                    {"file", ""},
                    {"line", event.code}}};
}

const std::array<LogJsonKind, 4> kKinds{{
    {LoggedKind::kStatus, "hitchview.PanoramaStatus", kStatusSchema, Status},
    {LoggedKind::kHitchAngle, "hitchview.HitchAngle", kHitchAngleSchema, HitchAngle},
    {LoggedKind::kCanFrame, "hitchview.CanFrame", kCanFrameSchema, CanFrame},
    {LoggedKind::kEvent, "foxglove.Log", kLogSchema, LogEntry},
}};

}  // namespace

const LogJsonKind* LogJsonKindOf(LoggedKind kind) {
    const auto* const known = std::ranges::find(kKinds, kind, &LogJsonKind::kind);
    return known == kKinds.end() ? nullptr : known;
}

}  // namespace hitchview::app
