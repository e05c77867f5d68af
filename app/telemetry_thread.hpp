#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "app/config.hpp"
#include "app/hitch_angle_decoder.hpp"
#include "hal/can_bus.hpp"
#include "hal/clock.hpp"
#include "hal/hitch_angle.hpp"
#include "hal/ring.hpp"

namespace hitchview::app {

struct TelemetryOptions {
    /// For recordings and simulation, which answer at once: an angle is held back until the frame
    /// sets have reached its moment. False for a live bus: it is handed over as it comes.
    bool paced = true;
    /// Of a live bus: tells how long it has been silent. Null: only the frames themselves do.
    const hal::Clock* clock = nullptr;
    std::chrono::milliseconds retry_after{200};  ///< after a bus that failed. > 0
};

/// Since the start.
struct TelemetryCounts {
    std::uint64_t frames = 0;    ///< received from the bus, of all ids
    std::uint64_t angles = 0;    ///< decoded, or found stale, and handed over
    std::uint64_t refused = 0;   ///< decoded and lost: nobody took the earlier ones
    std::uint64_t failures = 0;  ///< bus disconnected or failed; tried again
};

/// Carries the hitch angle from the CAN bus to the publisher on a thread of its own, named `can`.
/// It ends with the recording. Takes no memory after construction. Threads: Advance the run loop's,
/// Take the publisher's, counts any.
class TelemetryThread {
 public:
    static constexpr std::size_t kCapacity = 256;  ///< angles waiting to be taken

    /// `bus` must outlive the thread and belongs to it until then.
    TelemetryThread(hal::CanBus& bus, const HitchAngleSignal& signal,
                    const TelemetryOptions& options);
    /// Waits for the bus to answer, at most 50 ms, and for nothing else.
    ~TelemetryThread();
    TelemetryThread(const TelemetryThread&) = delete;
    TelemetryThread& operator=(const TelemetryThread&) = delete;

    /// Lets go of what was received until `captured`, the capture time of the newest frame set. An
    /// earlier moment than the last one changes nothing. Does not wait; without effect unless
    /// paced.
    void Advance(hal::Instant captured);

    /// Waits until what Advance let go of can be taken, at most 200 ms, so that the end of a run
    /// lacks nothing. Without effect unless paced. Thread: Advance's.
    void Settle() const;

    /// The next angle in the order of the bus; empty when there is none yet.
    std::optional<hal::HitchAngle> Take() { return angles_.Take(); }

    [[nodiscard]] TelemetryCounts counts() const;
    /// Places for angles that wait to be taken.
    [[nodiscard]] hal::PoolLevel pool() const { return angles_.level(); }

 private:
    void Work();
    void HandOver(const hal::CanFrame& frame);
    void HandOver(const std::optional<hal::HitchAngle>& maybe_angle);
    void TellSilence();
    void HoldUntil(hal::Instant received_at);
    [[nodiscard]] bool IsSettled() const;
    void RestAfterFailure();

    hal::CanBus& bus_;
    HitchAngleMonitor monitor_;  // the thread's
    const TelemetryOptions options_;

    hal::Ring<hal::HitchAngle, kCapacity> angles_;
    std::atomic<std::uint64_t> frames_{0};
    std::atomic<std::uint64_t> handed_over_{0};
    std::atomic<std::uint64_t> failures_{0};

    std::atomic<hal::Instant::rep>
        reached_ns_;  // never steps back; the largest value when stopping
    std::atomic<hal::Instant::rep>
        held_ns_;  // moment of the angle held back; the least when none is
    std::atomic<bool> ended_{false};
    std::atomic<bool> stop_{false};
    std::mutex rest_mutex_;  // with rested_: cuts a rest short, never held by Advance or Take
    std::condition_variable rested_;
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace hitchview::app
