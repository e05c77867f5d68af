#include "app/capture_thread.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/thread_schedule.hpp"

namespace hitchview::app {

CaptureThread::CaptureThread(hal::Camera& camera, std::string name, std::size_t index,
                             FrameInbox& inbox, EventQueue& events, hal::Clock& clock)
    : camera_(camera),
      name_(std::move(name)),
      index_(index),
      inbox_(inbox),
      events_(events),
      clock_(clock),
      thread_([this] { Work(); }) {}

CaptureThread::~CaptureThread() {
    stop_ = true;
    thread_.join();
}

void CaptureThread::Work() {
    constexpr std::chrono::milliseconds kPatience{100};
    NameThisThread("cam-" + name_);
    while (!stop_) {
        auto frame = camera_.WaitFrame(kPatience);
        const hal::Instant now = clock_.Now();
        if (frame) {
            inbox_.Put(index_, std::move(frame.value()), now);
            NoteFrame(now);
        } else if (frame.error() != hal::Error::kTimeout &&
                   frame.error() != hal::Error::kCorrupted) {
            inbox_.SetConnected(index_, false);
            NoteLost(now);
            BringBack();
        }
    }
}

void CaptureThread::NoteFrame(hal::Instant now) {
    pause_ = {};
    if (!lost_at_) return;
    const auto away = std::chrono::duration_cast<std::chrono::milliseconds>(now - *lost_at_);
    lost_at_.reset();
    Tell(hal::EventCode::kCameraBack, now,
         hal::EventText("back after ").AppendNumber(away.count()).Append(" ms"));
}

void CaptureThread::NoteLost(hal::Instant now) {
    if (lost_at_) return;  // it was had again, and gave nothing
    lost_at_ = now;
    Tell(hal::EventCode::kCameraLost, now,
         hal::EventText("lost: ").Append(hal::ToString(camera_.loss())));
    if (camera_.loss() == hal::CameraLoss::kOtherFormat)
        Tell(hal::EventCode::kCalibrationMismatch, now,
             {"gives another size or format than the rig was set up with"});
}

void CaptureThread::Tell(hal::EventCode code, hal::Instant when, const hal::EventText& text) {
    if (!events_.is_on_stderr())
        std::fprintf(stderr, "camera %s: %s\n", name_.c_str(), text.c_str());
    events_.Put({.code = code, .when = when, .subject = std::string_view(name_), .text = text});
}

void CaptureThread::BringBack() {
    while (!stop_) {
        clock_.SleepUntil(clock_.Now() + pause_);
        pause_ = std::clamp<hal::Instant>(2 * pause_, kFirstPause, kLongestPause);
        if (camera_.Reopen()) return;
    }
}

}  // namespace hitchview::app
