#include "app/log_check.hpp"

#include <algorithm>

#include "app/evaluation_statistics.hpp"
#include "app/log_sets.hpp"
#include "app/text_table.hpp"

namespace hitchview::app {
namespace {

using drivers::LoggedKind;

constexpr std::size_t kMostListed = 1000;

void Widen(double value, std::optional<double>& least, std::optional<double>& most) {
    least = std::min(least.value_or(value), value);
    most = std::max(most.value_or(value), value);
}

/// Texts of a log may hold any bytes; reports are UTF-8.
std::string Shown(std::string_view text) {
    return Printable(std::string(text));
}

/// Time stamps that tremble by a fifth of a millisecond leave 30 ppm unknown after ten seconds.
bool IsLong(const CameraFigures& camera) {
    constexpr double kShortest_ms = 10'000;
    const auto frames = static_cast<double>(camera.frames.messages);
    return camera.period_ms && frames * *camera.period_ms >= kShortest_ms;
}

std::optional<double> MiddlePeriod_ms(const std::vector<CameraFigures>& cameras) {
    std::vector<double> periods;
    for (const CameraFigures& camera : cameras)
        if (camera.period_ms) periods.push_back(*camera.period_ms);
    return Quantile(periods, 0.5);
}

}  // namespace

void LogCheck::Add(const drivers::LcmLogEvent& event) {
    Count(event);
    clock_.AddLogTime(event.utime_us);
    if (!AddMessage(event)) ++counts_.undecodable;
}

void LogCheck::Count(const drivers::LcmLogEvent& event) {
    const bool first = counts_.events++ == 0;
    counts_.first_us = first ? event.utime_us : std::min(counts_.first_us, event.utime_us);
    counts_.last_us = first ? event.utime_us : std::max(counts_.last_us, event.utime_us);
    ++counts_.channels[std::string(event.channel)];
}

bool LogCheck::AddMessage(const drivers::LcmLogEvent& event) {
    switch (channels_.KindOf(event)) {
        case LoggedKind::kImage:
            return AddImage(event);
        case LoggedKind::kCanFrame:
            return AddCanFrame(event.data);
        case LoggedKind::kHitchAngle:
            return AddHitchAngle(event.data);
        case LoggedKind::kStatus:
            return AddStatus(event.data);
        case LoggedKind::kClock:
            return AddClock(event.data);
        case LoggedKind::kEvent:
            return AddEvent(event.data);
        case LoggedKind::kRig:
            return AddRig(event.data);
        case LoggedKind::kUnknown:
            break;
    }
    return true;
}

bool LogCheck::AddImage(const drivers::LcmLogEvent& event) {
    const auto image = drivers::ParseLoggedImage(event.data);
    if (!image) return false;
    if (IsCameraChannel(event.channel)) {
        Camera(event.channel).Add(image.value());
    } else if (image.value().sequence) {
        images_.Add(*image.value().sequence);
    } else {
        images_.AddUnnumbered();
    }
    return true;
}

bool LogCheck::AddCanFrame(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedCanFrame(message);
    if (!logged) return false;
    const hal::CanFrame& frame = logged.value().frame;
    ++counts_.can.frames;
    counts_.can.errors += frame.kind == hal::CanFrameKind::kError ? 1 : 0;
    can_gaps_.Add(frame.received_at);
    return true;
}

bool LogCheck::AddHitchAngle(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedHitchAngle(message);
    if (!logged) return false;
    const hal::HitchAngle& angle = logged.value().angle;
    HitchAngleFigures& figures = counts_.hitch_angle;
    hitch_angles_.Add(logged.value().sequence);
    ++figures.qualities.at(static_cast<std::size_t>(angle.quality));
    if (angle.quality == hal::HitchAngleQuality::kValid)
        Widen(angle.angle_rad, figures.least_rad, figures.most_rad);
    articulation_.Add(angle);
    return true;
}

bool LogCheck::AddStatus(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedStatus(message);
    if (!logged) return false;
    const hal::PanoramaStatus& status = logged.value().status;
    status_.Add(status.sequence);
    counts_.panoramas.deadline_misses = status.deadline_misses;
    counts_.panoramas.dropped = status.dropped;
    status_clock_.Add(logged.value().utime_us, status.captured_from);
    articulation_.Add(status);
    return true;
}

bool LogCheck::AddClock(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedClock(message);
    if (!logged) return false;
    clock_.Add(logged.value().utime_us, logged.value().monotonic);
    return true;
}

bool LogCheck::AddEvent(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedEvent(message);
    if (!logged) return false;
    const drivers::LoggedEvent& event = logged.value();
    event_messages_.Add(event.sequence);
    if (counts_.listed_events.size() < kMostListed)
        counts_.listed_events.push_back(
            {event.utime_us, event.code, Shown(event.subject), Shown(event.text)});
    return true;
}

/// The cameras of the rig are known from now on, also those that never give a frame.
bool LogCheck::AddRig(std::span<const std::uint8_t> message) {
    const auto logged = drivers::ParseLoggedRig(message);
    if (!logged) return false;
    counts_.has_rig = true;
    counts_.calibration_id = Shown(logged.value().calibration_id);
    rig_period_ms_ = logged.value().period_ms;
    for (const std::string_view channel : logged.value().camera_channels)
        if (IsCameraChannel(channel)) Camera(channel);
    return true;
}

CameraStream& LogCheck::Camera(std::string_view channel) {
    const auto known = std::ranges::find(cameras_, channel, &CameraStream::channel);
    if (known != cameras_.end()) return *known;
    return cameras_.emplace_back(std::string(channel));
}

double LogCheck::Period_ms() const {
    if (rig_period_ms_) return *rig_period_ms_;
    std::vector<double> periods;
    for (const CameraStream& camera : cameras_)
        if (const auto period = camera.Period_ms()) periods.push_back(*period);
    return Quantile(periods, 0.5).value_or(0);
}

void LogCheck::AddCameras(LogFigures& figures) const {
    std::vector<std::vector<hal::Instant>> times;
    for (const CameraStream& camera : cameras_) {
        figures.cameras.push_back(camera.Figures(figures.period_ms));
        times.push_back(camera.times());
    }
    if (figures.period_ms > 0) figures.sets = MeasureSets(times, figures.period_ms);
    const std::optional<double> middle_ms = MiddlePeriod_ms(figures.cameras);
    for (CameraFigures& camera : figures.cameras)
        if (IsLong(camera)) camera.drift_ppm = 1e6 * (*camera.period_ms / *middle_ms - 1);
}

LogFigures LogCheck::Figures() const {
    LogFigures figures = counts_;
    figures.period_ms = Period_ms();
    AddCameras(figures);
    figures.can.gaps = can_gaps_.gaps();
    figures.can.longest_gap_ms = can_gaps_.longest_ms();
    figures.hitch_angle.messages = hitch_angles_.figures();
    figures.articulation = articulation_.Figures();
    figures.panoramas.images = images_.figures();
    figures.panoramas.status = status_.figures();
    figures.clock = clock_.figures();
    if (figures.clock.readings == 0) {
        figures.clock = status_clock_.figures();
        figures.clock.log_steps_back = clock_.figures().log_steps_back;
    }
    figures.event_messages = event_messages_.figures();
    return figures;
}

}  // namespace hitchview::app
