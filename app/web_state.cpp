#include "app/web_state.hpp"

#include <limits>

#include "app/web_json.hpp"
#include "drivers/lcm_log_messages.hpp"
#include "drivers/lcm_logged_health.hpp"
#include "drivers/lcm_logged_overlay.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using nlohmann::json;

using Message = std::span<const std::uint8_t>;

/// One minute at 30 Hz.
constexpr std::size_t kTracedStatuses = 1800;
/// Angles may come a hundred times a second: a chart needs no more than this.
constexpr std::chrono::milliseconds kAngleTracePeriod{50};
constexpr std::size_t kTracedAngles = 1200;
constexpr std::size_t kKeptEvents = 200;
constexpr std::size_t kLongestEventText = 512;

json AgeMs(std::optional<Instant> maybe_at, Instant now) {
    return maybe_at ? json(Milliseconds(now - *maybe_at)) : json();
}

std::int64_t WholeMs(Instant at) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(at).count();
}

}  // namespace

WebState::WebState(WebChannels channels, std::vector<WebCamera> cameras)
    : channels_(std::move(channels)),
      cameras_(std::move(cameras)),
      statuses_(kTracedStatuses),
      angles_(kTracedAngles),
      events_(kKeptEvents) {}

void WebState::Take(std::string_view channel, Message message, Instant now) {
    if (!TakeMessage(channel, message, now)) ++refused_;
}

bool WebState::TakeMessage(std::string_view channel, Message message, Instant now) {
    if (channel == channels_.panorama) return pictures_.TakePanorama(message, now);
    if (channel == channels_.status) return TakeStatus(message, now);
    if (channel == channels_.hitch_angle) return TakeHitchAngle(message, now);
    if (channel == channels_.event) return TakeEvent(message, now);
    if (channel == channels_.health) return TakeHealth(message, now);
    if (channel == channels_.overlay) return TakeOverlay(message);
    return channel.starts_with(channels_.preview_prefix) &&
           pictures_.TakePreview(channel.substr(channels_.preview_prefix.size()), message, now);
}

bool WebState::TakeStatus(Message message, Instant now) {
    const auto logged = drivers::ParseLoggedStatus(message);
    if (!logged) return false;
    const hal::PanoramaStatus& status = logged.value().status;
    status_ = StatusJson(status);
    status_at_ = now;
    urgent_ = urgent_ || status.cameras_missing != missing_;
    missing_ = status.cameras_missing;
    cameras_.TakeMissing(missing_, now);
    statuses_.Append({now, Milliseconds(status.published_at - status.captured_from),
                      Rounded(status.total_ms), Degrees(status.articulation_rad)});
    return true;
}

bool WebState::TakeHitchAngle(Message message, Instant now) {
    const auto logged = drivers::ParseLoggedHitchAngle(message);
    if (!logged) return false;
    const hal::HitchAngle& angle = logged.value().angle;
    angle_ = HitchAngleJson(angle);
    angle_at_ = now;
    if (angle_traced_at_ && now - *angle_traced_at_ < kAngleTracePeriod) return true;
    angle_traced_at_ = now;
    const bool valid = angle.quality == hal::HitchAngleQuality::kValid;
    angles_.Append(
        {now, valid ? Degrees(angle.angle_rad) : std::numeric_limits<double>::quiet_NaN()});
    return true;
}

bool WebState::TakeEvent(Message message, Instant now) {
    const auto logged = drivers::ParseLoggedEvent(message);
    if (!logged) return false;
    const drivers::LoggedEvent& event = logged.value();
    cameras_.TakeEvent(event, now);
    events_.Append({{"utime_ms", event.utime_us / 1000},
                    {"code", event.code},
                    {"subject", event.subject.substr(0, kLongestEventText)},
                    {"text", event.text.substr(0, kLongestEventText)}});
    urgent_ = true;
    return true;
}

bool WebState::TakeHealth(Message message, Instant now) {
    const auto health = drivers::ParseLoggedHealth(message);
    if (!health) return false;
    cameras_.TakeHealth(health.value(), now);
    health_ = HealthJson(health.value());
    health_at_ = now;
    ++health_serial_;
    return true;
}

bool WebState::TakeOverlay(Message message) {
    const auto overlay = drivers::ParseLoggedOverlay(message);
    if (!overlay) return false;
    overlay_ = Line(OverlayJson(overlay.value()));
    ++overlay_serial_;
    return true;
}

json WebState::PanoramaNews(Instant now) const {
    const WebPicture& panorama = pictures_.panorama();
    if (panorama.serial == 0) return nullptr;
    return {{"serial", panorama.serial},      {"sequence", panorama.sequence},
            {"width", panorama.width_px},     {"height", panorama.height_px},
            {"bytes", panorama.jpeg->size()}, {"age_ms", Milliseconds(now - panorama.arrived_at)}};
}

json WebState::Traces(const Cursor& cursor) const {
    json status = json::array();
    statuses_.VisitAfter(cursor.status, [&](std::uint64_t, const TracedStatus& traced) {
        status.push_back(
            {WholeMs(traced.at), traced.latency_ms, traced.total_ms, traced.articulation_deg});
    });
    json angles = json::array();
    angles_.VisitAfter(cursor.hitch_angle, [&](std::uint64_t, const TracedAngle& traced) {
        angles.push_back({WholeMs(traced.at), traced.angle_deg});
    });
    return {{"status", std::move(status)}, {"hitch_angle", std::move(angles)}};
}

std::string WebState::News(Cursor& cursor, Instant now) const {
    json events = json::array();
    events_.VisitAfter(cursor.event, [&](std::uint64_t number, const json& event) {
        events.push_back(event);
        events.back()["number"] = number;
    });
    json news{{"now_ms", WholeMs(now)},
              {"panorama", PanoramaNews(now)},
              {"status", status_},
              {"status_age_ms", AgeMs(status_at_, now)},
              {"hitch_angle", angle_},
              {"hitch_angle_age_ms", AgeMs(angle_at_, now)},
              {"health_age_ms", AgeMs(health_at_, now)},
              {"cameras", cameras_.ToJson(now)},
              {"previews", pictures_.newest_preview()},
              {"overlay", overlay_serial_},
              {"refused", refused_},
              {"traces", Traces(cursor)},
              {"events", std::move(events)}};
    if (cursor.health != health_serial_) news["health"] = health_;
    cursor = {statuses_.newest(), angles_.newest(), events_.newest(), health_serial_};
    return Line(news);
}

}  // namespace hitchview::app
