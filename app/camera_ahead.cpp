#include "app/camera_ahead.hpp"

#include "app/thread_schedule.hpp"

namespace hitchview::app {

CameraAhead::CameraAhead(std::unique_ptr<hal::Camera> camera, const std::string& name)
    : camera_(std::move(camera)) {
    thread_ = std::thread([this, name] {
        NameThisThread("src-" + name);
        Work();
    });
}

CameraAhead::~CameraAhead() {
    stop_ = true;
    outcomes_.Close();
    thread_.join();
}

void CameraAhead::Work() {
    constexpr std::chrono::milliseconds kPatience{50};
    while (!stop_) {
        auto answer = camera_->WaitFrame(kPatience);
        Outcome outcome;
        if (answer) {
            outcome.frame = std::move(answer.value());
        } else {
            outcome.error = answer.error();
            if (outcome.error == hal::Error::kTimeout) continue;
            if (outcome.error == hal::Error::kEndOfStream) break;
        }
        if (!outcomes_.Append(std::move(outcome))) break;
    }
    outcomes_.Close();
}

hal::Result<hal::FrameLease> CameraAhead::DoWaitFrame(std::chrono::milliseconds timeout) {
    auto outcome = outcomes_.TakeFor(timeout);
    if (!outcome) return outcomes_.finished() ? hal::Error::kEndOfStream : hal::Error::kTimeout;
    if (outcome->frame) return std::move(outcome->frame);
    return outcome->error;
}

}  // namespace hitchview::app
