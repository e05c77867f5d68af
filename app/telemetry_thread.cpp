#include "app/telemetry_thread.hpp"

#include <limits>

#include "app/thread_schedule.hpp"
#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using Limits = std::numeric_limits<Instant::rep>;

constexpr std::chrono::milliseconds kLongestWait{50};

}  // namespace

TelemetryThread::TelemetryThread(hal::CanBus& bus, const HitchAngleSignal& signal,
                                 const TelemetryOptions& options)
    : bus_(bus),
      monitor_(signal),
      options_(options),
      reached_ns_(options.paced ? Limits::min() : Limits::max()),
      held_ns_(Limits::min()) {
    HV_EXPECT(options.retry_after.count() > 0);
    thread_ = std::thread([this] { Work(); });
}

TelemetryThread::~TelemetryThread() {
    {
        const std::lock_guard lock(rest_mutex_);
        stop_ = true;
    }
    rested_.notify_one();
    Advance(Instant::max());
    thread_.join();
}

void TelemetryThread::Advance(Instant captured) {
    Instant::rep reached_ns = reached_ns_.load();
    while (reached_ns < captured.count()) {
        if (reached_ns_.compare_exchange_weak(reached_ns, captured.count())) {
            reached_ns_.notify_all();
            return;
        }
    }
}

TelemetryCounts TelemetryThread::counts() const {
    return {.frames = frames_,
            .angles = handed_over_,
            .refused = angles_.refused(),
            .failures = failures_};
}

void TelemetryThread::Work() {
    NameThisThread("can");
    while (!stop_) {
        const hal::Result<hal::CanFrame> frame = bus_.WaitFrame(kLongestWait);
        if (frame) {
            HandOver(frame.value());
            continue;
        }
        if (frame.error() == hal::Error::kEndOfStream) {
            ended_ = true;
            return;
        }
        TellSilence();
        if (frame.error() != hal::Error::kTimeout) RestAfterFailure();
    }
}

void TelemetryThread::HandOver(const hal::CanFrame& frame) {
    ++frames_;
    HandOver(monitor_.Stale(frame.received_at));
    HandOver(monitor_.Decode(frame));
}

void TelemetryThread::HandOver(const std::optional<hal::HitchAngle>& maybe_angle) {
    if (!maybe_angle) return;
    HoldUntil(maybe_angle->received_at);
    if (!stop_ && angles_.Append(*maybe_angle)) ++handed_over_;
}

void TelemetryThread::TellSilence() {
    if (options_.clock != nullptr) HandOver(monitor_.Stale(options_.clock->Now()));
}

void TelemetryThread::HoldUntil(Instant received_at) {
    held_ns_ = received_at.count();
    Instant::rep reached_ns = reached_ns_.load();
    while (reached_ns < received_at.count()) {
        reached_ns_.wait(reached_ns);
        reached_ns = reached_ns_.load();
    }
    held_ns_ = Limits::min();
}

bool TelemetryThread::IsSettled() const {
    return ended_ || held_ns_ > reached_ns_;
}

void TelemetryThread::Settle() const {
    constexpr std::chrono::milliseconds kLongest{200};
    constexpr std::chrono::milliseconds kPause{1};
    if (!options_.paced) return;
    for (auto waited = kPause; waited <= kLongest && !IsSettled(); waited += kPause)
        std::this_thread::sleep_for(kPause);
}

void TelemetryThread::RestAfterFailure() {
    ++failures_;
    std::unique_lock lock(rest_mutex_);
    rested_.wait_for(lock, options_.retry_after, [this] { return stop_.load(); });
}

}  // namespace hitchview::app
