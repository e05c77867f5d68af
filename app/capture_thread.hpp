#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "app/event_queue.hpp"
#include "app/frame_inbox.hpp"
#include "hal/camera.hpp"
#include "hal/clock.hpp"

namespace hitchview::app {

/// Carries one live camera's frames to the inbox on a thread of its own, named `cam-<name>`, and
/// has the camera reopened when it is gone, with pauses from kFirstPause that double up to
/// kLongestPause until it gives a frame. Says as an event, and on stderr unless events get there
/// anyway, when a camera goes, and when it gives frames again. All references must outlive it. Takes no memory after construction.
class CaptureThread {
 public:
    static constexpr std::chrono::milliseconds kFirstPause{100};
    static constexpr std::chrono::milliseconds kLongestPause{500};

    CaptureThread(hal::Camera& camera, std::string name, std::size_t index, FrameInbox& inbox,
                  EventQueue& events, hal::Clock& clock);
    /// Waits for the camera's answer, at most 100 ms, or the end of a pause.
    ~CaptureThread();
    CaptureThread(const CaptureThread&) = delete;
    CaptureThread& operator=(const CaptureThread&) = delete;

 private:
    void Work();
    void NoteFrame(hal::Instant now);
    void NoteLost(hal::Instant now);
    void Tell(hal::EventCode code, hal::Instant when, const hal::EventText& text);
    void BringBack();

    hal::Camera& camera_;
    const std::string name_;
    const std::size_t index_;
    FrameInbox& inbox_;
    EventQueue& events_;
    hal::Clock& clock_;
    std::optional<hal::Instant> lost_at_;  ///< while it gives no frames
    hal::Instant pause_{};                 ///< before it is reopened
    std::atomic<bool> stop_{false};
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace hitchview::app
