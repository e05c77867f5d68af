#include "app/log_replay.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/log_moment.hpp"
#include "app/log_time.hpp"
#include "app/thread_schedule.hpp"

namespace hitchview::app {
namespace {

drivers::LcmLogPictureKind KindOf(const LogCameraConfig& camera) {
    return {.format = camera.format, .compressed = camera.compressed};
}

drivers::LcmLogPlace PlaceOf(const LogMerge::Event& event) {
    const drivers::LcmLogEvent& e = event.event;
    return {.file = event.file,
            .position_bytes = e.position_bytes + drivers::kLcmLogHeaderBytes + e.channel.size(),
            .size_bytes = static_cast<std::uint32_t>(e.data.size())};
}

}  // namespace

LogReplay::LogReplay(const RigConfig& config, hal::Instant period, std::vector<LogCamera> cameras,
                     drivers::LcmLogCanBus* can_bus)
    : config_(config.log),
      cameras_(std::move(cameras)),
      seen_(cameras_.size()),
      can_bus_(can_bus),
      timeline_(period),
      former_(cameras_.size(), period, config.set_tolerance.value_or(period)),
      recordings_(config_.recordings, stop_),
      thread_([this] { Work(); }) {}

LogReplay::~LogReplay() {
    stop_ = true;
    sets_.Close();
    for (const LogCamera& camera : cameras_) camera.source->Close();
    thread_.join();
}

void LogReplay::Work() {
    NameThisThread("src-log");
    Read();
    former_.Finish();
    (void)HandOver();
    for (const LogCamera& camera : cameras_) camera.source->Close();
    if (can_bus_ != nullptr) can_bus_->Close();
    sets_.Close();
}

void LogReplay::Read() {
    if (config_.from_us > 0) recordings_.SeekToTime(config_.from_us);
    auto event = recordings_.Next();
    for (; event && past_end_ < kSurelyPastEnd; event = recordings_.Next()) {
        if (IsPastEnd(event.value().event.utime_us)) continue;
        if (!Take(event.value()) || !HandOver()) return;
    }
    if (event) return;
    if (event.error() != hal::Error::kEndOfStream && !stop_) Say(recordings_.failure());
}

/// One event alone may bear a damaged time.
bool LogReplay::IsPastEnd(std::int64_t utime_us) {
    const bool past = config_.to_us && utime_us >= *config_.to_us;
    past_end_ = past ? past_end_ + 1 : 0;
    return past;
}

/// False when the replay cannot go on.
bool LogReplay::Take(const LogMerge::Event& event) {
    const auto camera = std::ranges::find_if(cameras_, [&](const LogCamera& c) {
        return c.config.recording == event.recording && c.config.channel == event.event.channel;
    });
    if (camera != cameras_.end())
        return TakeFrame(static_cast<std::size_t>(camera - cameras_.begin()), event);
    switch (drivers::KindOf(event.event.data)) {
        case drivers::LoggedKind::kRig:
            return !IsOtherRig(event.event);
        case drivers::LoggedKind::kCanFrame:
            if (can_bus_ != nullptr) TakeCanFrame(event.event);
            return true;
        default:
            return true;
    }
}

/// Whether the recording goes on with another calibration than the one it is replayed with: a whole
/// one, for an id alone may be damaged.
bool LogReplay::IsOtherRig(const drivers::LcmLogEvent& event) {
    const auto rig = drivers::ParseLoggedRig(event.data);
    const std::string& known = config_.calibration_id;
    if (!rig || known.empty() || rig.value().calibration_id == known) return false;
    const std::string stated(rig.value().calibration_id);
    const auto other =
        calib::ParseCalibration(std::string(rig.value().calibration_yaml), "").calibration;
    if (!other || other->id() != stated) return false;
    Say("the recording goes on with another calibration at " + UtcText(event.utime_us) + ", " +
        stated + " after " + known + ": replay the parts by themselves, or with --rig");
    return true;
}

bool LogReplay::TakeFrame(std::size_t camera, const LogMerge::Event& event) {
    const auto image = drivers::ParseLoggedImage(event.event.data);
    if (!image) return true;
    if (drivers::PictureKindOf(image.value()) != KindOf(cameras_[camera].config))
        return !IsOther(camera, image.value(), event.event.utime_us);
    Seen& seen = seen_[camera];
    seen.others = 0;
    const auto logged = MomentOf(image.value(), event.event.utime_us, config_.stamped);
    const auto moment = logged ? timeline_.Add(*logged) : std::nullopt;
    if (!moment) return true;
    const std::uint32_t sequence = image.value().sequence.value_or(seen.frames);
    ++seen.frames;
    former_.Add({.camera = camera,
                 .header = {.sequence = sequence, .captured_at = *moment},
                 .place = PlaceOf(event)});
    return true;
}

void LogReplay::TakeCanFrame(const drivers::LcmLogEvent& event) {
    const auto logged = drivers::ParseLoggedCanFrame(event.data);
    if (!logged) return;
    if (early_can_.size() == kMostEarlyCanFrames) early_can_.erase(early_can_.begin());
    early_can_.push_back(logged.value().frame);
    HandOverCanFrames();
}

/// As soon as it is known when they came.
void LogReplay::HandOverCanFrames() {
    if (!timeline_.started()) return;
    for (hal::CanFrame& frame : early_can_) {
        const auto moment = timeline_.MomentOf(config_.stamped ? frame.received_at : frame.epoch);
        if (!moment) continue;
        frame.received_at = *moment;
        can_bus_->Append(frame);
    }
    early_can_.clear();
}

/// Whether the camera has become another one, for good.
bool LogReplay::IsOther(std::size_t camera, const drivers::LoggedImage& image,
                        std::int64_t utime_us) {
    if (++seen_[camera].others < kMostOthers) return false;
    const LogCameraConfig& config = cameras_[camera].config;
    Say("camera " + cameras_[camera].name + ": the pictures of channel " + config.channel +
        " change in the recording, before " + UtcText(utime_us) + ", from " +
        Describe(KindOf(config)) + " to " + Describe(image));
    return true;
}

void LogReplay::Say(const std::string& failure) {
    std::fprintf(stderr, "%s\n", failure.c_str());
    failed_ = true;
}

/// Sets that are known. False once nobody wants them.
bool LogReplay::HandOver() {
    while (auto set = former_.Take()) {
        for (std::size_t i = 0; i < cameras_.size(); ++i) {
            const auto& frame = set->frames[i];
            if (frame && !cameras_[i].source->Append(frame->header, frame->place)) return false;
        }
        if (!sets_.Append(*set)) return false;
    }
    return true;
}

hal::Result<hal::FrameLease> LogReplay::WaitFrame(const LogCamera& camera) const {
    constexpr std::chrono::milliseconds kPatience{1000};
    constexpr int kTries = 60;  // a recording on a slow disk is waited for
    for (int i = 0; i < kTries; ++i) {
        auto frame = camera.camera->WaitFrame(kPatience);
        if (frame || frame.error() != hal::Error::kTimeout) return frame;
    }
    return hal::Error::kTimeout;
}

hal::Result<FrameSet> LogReplay::DoWaitSet() {
    const auto wanted = sets_.Take();
    if (!wanted) return failed_ ? hal::Error::kFailed : hal::Error::kEndOfStream;
    FrameSet set;
    set.sequence = wanted->sequence;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        const LogCamera& camera = cameras_[i];
        auto frame = wanted->frames[i] ? WaitFrame(camera) : hal::Error::kCorrupted;
        if (!frame && frame.error() != hal::Error::kCorrupted) return frame.error();
        if (!frame) {
            set.cameras_missing |= 1U << i;
            continue;
        }
        set.leases[camera.unit][camera.index_in_unit] = std::move(*frame);
    }
    set.FindMoments();
    return set;
}

}  // namespace hitchview::app
