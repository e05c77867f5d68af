#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "app/event_queue.hpp"
#include "app/jpeg_encoder.hpp"
#include "app/run_watch.hpp"
#include "app/side_channels.hpp"
#include "app/stage_times.hpp"
#include "app/telemetry_thread.hpp"
#include "app/worker_pool.hpp"
#include "hal/blocking_ring.hpp"
#include "hal/clock.hpp"
#include "hal/frame_pool.hpp"
#include "hal/publisher.hpp"
#include "hal/watchdog.hpp"

namespace hitchview::app {

struct PanoramaPublisherOptions {
    JpegQualityGovernorOptions jpeg{};
    std::string calibration_id;
    /// Real time: what does not get away in time is dropped, so that no latency queues up. False:
    /// Append waits, nothing is dropped (unpaced replay).
    bool drop_when_late = true;
    double speed = 1;  ///< of the telemetry's time, if it is a recording's; see AtSpeed
    /// The telemetry's moments are the clock's already, not those of a recording.
    bool live_telemetry = false;
    /// Threads that compress; beyond JpegEncoder::kSlices they do not help.
    int threads = 1;
    SideSources side{};  ///< what is sent beside the panoramas and made of them
};

/// What is sent beside the panoramas; null: nothing of the kind.
struct SentBeside {
    TelemetryThread* telemetry = nullptr;
    EventQueue* events = nullptr;
    RunWatch* watch = nullptr;          ///< health, and the events that it puts into `events`
    hal::Watchdog* watchdog = nullptr;  ///< of the service manager: fed by each panorama sent
};

/// Compresses and sends panoramas off the deadline, on a thread of its own (`publish`), which
/// `publish-1` ... help to compress, and hands on the hitch angles and events that have come
/// meanwhile and, once a second, the program's health. Memory is taken at construction.
class PanoramaPublisher {
 public:
    /// All that is referred to must outlive this.
    PanoramaPublisher(hal::Publisher& publisher, const hal::Clock& clock, const SentBeside& beside,
                      const hal::FrameFormat& format, const PanoramaPublisherOptions& options);
    ~PanoramaPublisher();

    /// Before the telemetry first lets go of an angle, and when its pace slips: moment of the clock
    /// that is moment 0 of the telemetry.
    void StartRecording(hal::Instant start) {
        start_ns_.store(start.count(), std::memory_order_release);
    }

    struct Item {
        hal::FrameView picture;  ///< borrowed for the call
        hal::Instant captured_until{};
        hal::PanoramaStatus status;  ///< published_at and dropped are filled in here
    };
    /// Copies the picture. False: all buffers are still being sent, this one is dropped and
    /// counted. Thread: pipeline.
    bool Append(const Item& item);
    /// Sends what is left and ends the thread. Once.
    void Finish();

    /// After Finish.
    [[nodiscard]] const PublishTimes& times() const { return times_; }
    /// Buffers for panoramas that are being sent or wait for it.
    [[nodiscard]] hal::PoolLevel pool() const;

    [[nodiscard]] std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t published() const {
        return counts_.published.load(std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint64_t refused() const {
        return counts_.refused.load(std::memory_order_relaxed);
    }

 private:
    struct Filled {
        hal::FramePool::Slot slot{};
        Item item;
    };
    static constexpr std::size_t kBuffers = 4;
    /// One is being sent, one waits: it is at most a period old when its turn comes.
    static constexpr int kBuffersInTime = 2;

    void Work();
    void Send(Filled& filled);
    void SendImage(const Item& item, const hal::PanoramaImage& image);
    void Feed();
    hal::Result<std::span<const std::uint8_t>> Compress(const hal::FrameView& picture);
    [[nodiscard]] hal::PanoramaImage ImageOf(const Item& item,
                                             std::span<const std::uint8_t> jpeg) const;
    void SendStatus(const Item& item);
    void SendHitchAngles();
    void SendEvents();
    void SendHealth();
    void Complete(hal::Health& health) const;

    hal::Publisher& publisher_;
    const hal::Clock& clock_;
    SentBeside beside_;
    PanoramaPublisherOptions options_;
    hal::FramePool pool_;
    hal::BlockingRing<hal::FramePool::Slot, kBuffers> free_;
    hal::BlockingRing<Filled, kBuffers> filled_;
    JpegEncoder encoder_;
    WorkerPool helpers_;
    PublishTimes times_;
    int newest_bytes_ = 0;  // of the newest panorama as JPEG
    int newest_quality_ = 0;
    bool ready_ = false;  // a panorama was handed over
    std::atomic<hal::Instant::rep> start_ns_{0};
    std::atomic<std::uint64_t> dropped_{0};
    PublishCounts counts_;
    SideChannels side_;
    std::thread thread_;
};

}  // namespace hitchview::app
