#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "app/record_folder.hpp"
#include "app/record_ring.hpp"
#include "drivers/lcm_log_writer.hpp"
#include "drivers/lcm_record_messages.hpp"
#include "hal/clock.hpp"
#include "hal/event.hpp"

namespace hitchview::app {

/// What was written so far.
struct WrittenCounts {
    std::uint64_t files = 0;
    std::uint64_t bytes = 0;
    std::uint64_t events = 0;
};

/// Writes events into segments: each begins with RIG, ends after a while, and is on the disk within
/// a second. Takes no memory after construction. Thread: one; counts and free_bytes: any.
class RecordWriter {
 public:
    /// Done, or why not, for people.
    using Outcome = hal::Result<hal::Done, hal::EventText>;

    struct Options {
        std::chrono::microseconds segment = std::chrono::seconds(60);
        /// Segments last so long of time. False: of the times of their events.
        bool live = true;
    };
    /// `clock` must outlive it.
    RecordWriter(RecordFolder folder, const drivers::RecordedRig& rig, const Options& options,
                 hal::Clock& clock);

    /// A recording begins with the next event, in a file of its own.
    void Begin(std::int64_t utime_us) { folder_.Begin(utime_us); }
    /// On failure the segment ends: it holds whole events only. The next call begins another.
    Outcome Append(const RecordedEvent& event);
    /// Once a second: waits for the disk, and looks whether space is left.
    Outcome Beat();
    /// Whether the folder has room for a while.
    [[nodiscard]] bool CanBegin();
    /// Ends the segment.
    void Close();

    /// Name of the newest segment.
    [[nodiscard]] std::string_view segment() const { return folder_.newest_name(); }
    [[nodiscard]] WrittenCounts counts() const { return {files_, bytes_, events_}; }
    [[nodiscard]] std::int64_t free_bytes() const { return free_bytes_; }

 private:
    [[nodiscard]] std::int64_t SegmentTime_us(std::int64_t utime_us) const;
    [[nodiscard]] bool IsDue(std::int64_t utime_us) const;
    Outcome OpenSegment(std::int64_t utime_us);
    hal::Result<hal::Done> Write(std::int64_t utime_us, std::string_view channel,
                                 std::span<const std::uint8_t> data);
    Outcome Fail();
    Outcome CheckSpace();

    RecordFolder folder_;
    drivers::RigMessage rig_;
    Options options_;
    hal::Clock& clock_;
    drivers::LcmLogWriter log_;
    std::int64_t begun_us_ = 0;  // the open segment, on the clock that its length is measured by
    hal::Instant next_beat_{};
    std::atomic<std::uint64_t> files_{0};
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<std::uint64_t> events_{0};
    std::atomic<std::int64_t> free_bytes_{0};
};

}  // namespace hitchview::app
