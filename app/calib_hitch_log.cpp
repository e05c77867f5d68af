#include "app/calib_hitch_log.hpp"

#include <atomic>
#include <cmath>

#include "app/log_channels.hpp"
#include "app/log_recording.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::app {
namespace {

struct TimedAngle {
    std::int64_t at_ns = 0;
    double angle_rad = 0;
};

/// Both angles of a recording, each in the order of its messages.
struct Angles {
    std::vector<TimedAngle> sensor{};
    std::vector<TimedAngle> images{};
};

void ReadSignal(std::string_view rig_yaml, HitchLog& log) {
    calib::YamlComplaints ignored("rig");
    calib::YamlMap root = calib::ParseYaml(std::string(rig_yaml), ignored);
    calib::YamlMap can = root["can"].Map();
    calib::YamlMap signal = can["hitch_angle"].Map();
    const calib::YamlValue factor = signal["factor_deg"];
    if (!factor.given()) return;
    double factor_deg = 0;
    factor.Read(calib::Range<double>{-1e6, 1e6}, factor_deg);
    signal["offset_deg"].Read(calib::Range<double>{-1e6, 1e6}, log.offset_deg);
    if (factor_deg != 0) log.factor_deg = factor_deg;
}

void Take(const drivers::LcmLogEvent& event, drivers::LoggedKind kind, Angles& angles,
          HitchLog& log) {
    if (kind == drivers::LoggedKind::kHitchAngle) {
        auto message = drivers::ParseLoggedHitchAngle(event.data);
        if (message && message->angle.quality == hal::HitchAngleQuality::kValid)
            angles.sensor.push_back({message->angle.received_at.count(), message->angle.angle_rad});
    } else if (kind == drivers::LoggedKind::kStatus) {
        auto message = drivers::ParseLoggedStatus(event.data);
        if (message && std::isfinite(message->status.articulation_rad))
            angles.images.push_back(
                {message->status.captured_from.count(), message->status.articulation_rad});
    } else if (kind == drivers::LoggedKind::kRig) {
        auto message = drivers::ParseLoggedRig(event.data);
        if (message) ReadSignal(message->rig_yaml, log);
    }
}

/// Moments of the sensor around each of the images; both go on in time.
std::vector<calib::AnglePair> Pairs(const Angles& angles) {
    constexpr std::int64_t kLongest_ns = 200'000'000;
    std::vector<calib::AnglePair> pairs;
    std::size_t late = 1;
    for (const TimedAngle& image : angles.images) {
        while (late < angles.sensor.size() && angles.sensor[late].at_ns < image.at_ns) ++late;
        if (late >= angles.sensor.size()) break;
        const TimedAngle& before = angles.sensor[late - 1];
        const TimedAngle& after = angles.sensor[late];
        const std::int64_t between_ns = after.at_ns - before.at_ns;
        if (before.at_ns > image.at_ns || between_ns <= 0 || between_ns > kLongest_ns) continue;
        const double share =
            static_cast<double>(image.at_ns - before.at_ns) / static_cast<double>(between_ns);
        pairs.push_back({static_cast<double>(image.at_ns) / 1e9,
                         before.angle_rad + share * (after.angle_rad - before.angle_rad),
                         image.angle_rad});
    }
    return pairs;
}

}  // namespace

hal::Checked<HitchLog> ReadHitchLog(const std::vector<std::filesystem::path>& logs) {
    auto files = LogFiles(logs);
    if (!files) return files.error();
    const std::atomic<bool> stop{false};
    LogRecording recording(files.value(), stop);
    LogChannels channels;
    Angles angles;
    HitchLog log;
    auto event = recording.Next();
    for (; event; event = recording.Next())
        Take(event.value(), channels.KindOf(event.value()), angles, log);
    if (event.error() != hal::Error::kEndOfStream) return recording.failure();
    const std::string where = logs.front().string();
    if (angles.sensor.empty()) return where + ": has no valid hitch angle (HITCH_ANGLE)";
    if (angles.images.empty())
        return where + ": has no articulation from the images (PANORAMA_STATUS)";
    log.pairs = Pairs(angles);
    if (log.pairs.empty())
        return where + ": hitch angles and articulations are never of the same moment";
    return log;
}

}  // namespace hitchview::app
