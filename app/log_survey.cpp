#include "app/log_survey.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "app/log_merge.hpp"
#include "app/log_moment.hpp"

namespace hitchview::app {
namespace {

using drivers::LcmLogPictureKind;
using drivers::LoggedImage;
using hal::Instant;

constexpr std::size_t kTimesForPeriod = 16;
constexpr std::int64_t kLongestSearchForCan_us = 3'000'000;

/// What is known of one camera.
struct Found {
    CameraConfig* camera;
    std::optional<LcmLogPictureKind> candidate{};  ///< seen in the newest picture
    std::optional<LcmLogPictureKind> kind{};       ///< seen in two pictures in a row
    std::string refused{};                         ///< a picture that nothing can be made of
    bool stamped = true;
    std::vector<Instant> times{};

    void Add(const LoggedImage& image, std::int64_t utime_us) {
        const auto seen = drivers::PictureKindOf(image);
        if (!seen) refused = Describe(image);
        if (seen && seen == candidate && !kind) kind = seen;
        candidate = seen;
        stamped = stamped && image.captured_at.has_value();
        const auto at = MomentOf(image, utime_us, image.captured_at.has_value());
        if (at && times.size() < kTimesForPeriod) times.push_back(*at);
    }
    /// One picture is enough where there is no other.
    void Settle() {
        if (!kind) kind = candidate;
    }
};

class Survey {
 public:
    explicit Survey(RigConfig& config) : config_(config) {
        for (const algo::Unit unit : algo::kUnits) {
            for (CameraConfig& camera : config.units[unit].cameras)
                if (camera.source == CameraConfig::Source::kLog) found_.push_back({&camera});
        }
        wants_can_ = config.can && config.can->source == CanConfig::Source::kLog;
    }

    void Add(const LogMerge::Event& event) {
        const drivers::LcmLogEvent& e = event.event;
        if (!first_us_) first_us_ = e.utime_us;
        newest_us_ = e.utime_us;
        has_can_ = has_can_ || drivers::KindOf(e.data) == drivers::LoggedKind::kCanFrame;
        const auto found = std::ranges::find_if(found_, [&](const Found& f) {
            const LogCameraConfig& log = f.camera->log;
            return log.recording == event.recording && log.channel == e.channel;
        });
        if (found == found_.end()) return;
        if (const auto image = drivers::ParseLoggedImage(e.data))
            found->Add(image.value(), e.utime_us);
    }

    [[nodiscard]] bool IsDone() const {
        const bool can =
            !wants_can_ || has_can_ || newest_us_ - first_us_.value_or(0) > kLongestSearchForCan_us;
        return can && std::ranges::all_of(found_, [this](const Found& f) {
                   return f.kind && (config_.period || f.times.size() == kTimesForPeriod);
               });
    }

    hal::Checked<hal::Done> Apply() {
        for (Found& found : found_) {
            found.Settle();
            if (!found.kind) return Missing(found);
            found.camera->log.format = found.kind->format;
            found.camera->log.compressed = found.kind->compressed;
        }
        config_.log.stamped = std::ranges::all_of(found_, &Found::stamped);
        if (!config_.period) config_.period = Period();
        if (wants_can_ && !has_can_) {
            std::fprintf(stderr,
                         "the recording has no CAN frames: no hitch angle is decoded from it\n");
            config_.can.reset();
        }
        return hal::Done{};
    }

 private:
    [[nodiscard]] std::string Missing(const Found& found) const {
        const LogCameraConfig& log = found.camera->log;
        const std::string where = config_.log.recordings[log.recording].front().string() +
                                  ": camera " + found.camera->name + ": channel " + log.channel;
        if (found.refused.empty()) return where + " has no picture, must have some";
        return where + " has pictures of " + found.refused +
               ", must be MJPG, UYVY, YUYV, NV12 or GREY of an even size";
    }

    /// The middle one of the steps between a camera's frames.
    [[nodiscard]] std::optional<Instant> Period() const {
        std::vector<Instant> steps;
        for (const Found& found : found_) {
            for (std::size_t i = 1; i < found.times.size(); ++i)
                steps.push_back(found.times[i] - found.times[i - 1]);
        }
        if (steps.empty()) return std::nullopt;
        const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
        std::ranges::nth_element(steps, middle);
        using std::chrono::milliseconds;
        if (*middle < milliseconds(1) || *middle > milliseconds(1000)) return std::nullopt;
        return *middle;
    }

    RigConfig& config_;
    std::vector<Found> found_;
    bool wants_can_ = false;
    bool has_can_ = false;
    std::optional<std::int64_t> first_us_;
    std::int64_t newest_us_ = 0;
};

}  // namespace

hal::Checked<hal::Done> SurveyLogs(RigConfig& config, const std::atomic<bool>& stop) {
    LogMerge recordings(config.log.recordings, stop);
    if (config.log.from_us > 0) recordings.SeekToTime(config.log.from_us);
    Survey survey(config);
    auto event = recordings.Next();
    for (; event && !survey.IsDone(); event = recordings.Next()) survey.Add(event.value());
    if (!event && event.error() != hal::Error::kEndOfStream) return recordings.failure();
    return survey.Apply();
}

}  // namespace hitchview::app
