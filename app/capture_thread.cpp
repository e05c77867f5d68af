#include "app/capture_thread.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/thread_schedule.hpp"

namespace hitchview::app {

CaptureThread::CaptureThread(hal::Camera& camera, std::string name, std::size_t index,
                             FrameInbox& inbox, hal::Clock& clock)
    : camera_(camera),
      name_(std::move(name)),
      index_(index),
      inbox_(inbox),
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
        if (frame) {
            inbox_.Put(index_, std::move(frame.value()), clock_.Now());
        } else if (frame.error() != hal::Error::kTimeout &&
                   frame.error() != hal::Error::kCorrupted) {
            std::fprintf(stderr, "camera %s is lost: %s\n", name_.c_str(),
                         hal::ToString(frame.error()));
            inbox_.SetConnected(index_, false);
            BringBack();
        }
    }
}

void CaptureThread::BringBack() {
    auto pause = kFirstPause;
    while (!stop_) {
        if (camera_.Reopen()) {
            std::fprintf(stderr, "camera %s is back\n", name_.c_str());
            return;
        }
        clock_.SleepUntil(clock_.Now() + pause);
        pause = std::min(2 * pause, kLongestPause);
    }
}

}  // namespace hitchview::app
