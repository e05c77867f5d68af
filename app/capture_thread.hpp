#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "app/frame_inbox.hpp"
#include "hal/camera.hpp"
#include "hal/clock.hpp"

namespace hitchview::app {

/// Carries one live camera's frames to the inbox on a thread of its own, named `cam-<name>`, and
/// has the camera reopened when it is gone, with pauses from kFirstPause that double up to
/// kLongestPause. Says on stderr when a camera goes and comes back. The camera, the inbox and the
/// clock must outlive it. Takes no memory after construction.
class CaptureThread {
 public:
    static constexpr std::chrono::milliseconds kFirstPause{100};
    static constexpr std::chrono::milliseconds kLongestPause{500};

    CaptureThread(hal::Camera& camera, std::string name, std::size_t index, FrameInbox& inbox,
                  hal::Clock& clock);
    /// Waits for the camera's answer, at most 100 ms, or the end of a pause.
    ~CaptureThread();
    CaptureThread(const CaptureThread&) = delete;
    CaptureThread& operator=(const CaptureThread&) = delete;

 private:
    void Work();
    void BringBack();

    hal::Camera& camera_;
    const std::string name_;
    const std::size_t index_;
    FrameInbox& inbox_;
    hal::Clock& clock_;
    std::atomic<bool> stop_{false};
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace hitchview::app
