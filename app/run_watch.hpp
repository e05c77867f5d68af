#pragma once

#include <atomic>
#include <optional>

#include "app/deadline_events.hpp"
#include "app/event_queue.hpp"
#include "app/health_monitor.hpp"
#include "app/receive_buffer.hpp"
#include "app/seam_events.hpp"
#include "hal/ring.hpp"

namespace hitchview::app {

struct RunWatchOptions {
    HealthOptions health;
    algo::PerOverlap<bool> overlaps{};  ///< that the rig has
    hal::Instant period{};
    bool realtime = true;  ///< otherwise there is no deadline to be missed
    ReceiveBufferVerdict receive_buffer{};
};

/// Watches a run off the frame path: the pipeline leaves a few figures with each panorama, and the
/// thread that publishes makes events and once a second a health message of them. Takes no memory
/// after construction.
class RunWatch {
 public:
    static constexpr hal::Instant kHealthPeriod = std::chrono::seconds(1);

    /// `events` must outlive it.
    RunWatch(const RunWatchOptions& options, EventQueue& events);

    /// READY: health is told from now on. Later calls change nothing. Thread: pipeline.
    void Start(hal::Instant now);
    /// Does not wait; figures that nobody has taken for a second are left out. Thread: pipeline.
    void Add(const FrameFigures& figures) { figures_.Append(figures); }

    /// Takes what was left and puts the events that follow from it. `unsent`: panoramas that were
    /// made and not sent, since the start. Thread: publisher.
    void Update(hal::Instant now, std::uint64_t unsent);
    /// Once in kHealthPeriod. What the publisher alone knows is for it to fill in. Same thread.
    std::optional<hal::Health> MaybeHealth(hal::Instant now);

 private:
    void Note(const FrameFigures& figures, hal::Instant now);
    void Put(const std::optional<hal::Event>& maybe_event);

    RunWatchOptions options_;
    EventQueue& events_;
    hal::Ring<FrameFigures, 64> figures_;
    std::atomic<bool> started_{false};
    hal::Instant next_health_{};  // written before started_
    HealthMonitor health_;        // its Start too
    algo::PerOverlap<SeamEvents> seams_;
    DeadlineEvents deadlines_;
    DropEvents drops_;
    FrameFigures newest_{};
    std::uint64_t unsent_ = 0;
};

}  // namespace hitchview::app
