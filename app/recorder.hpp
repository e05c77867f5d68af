#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/config.hpp"
#include "app/frame_recorder.hpp"
#include "app/record_intake.hpp"
#include "app/record_writer.hpp"
#include "hal/health.hpp"

namespace hitchview::app {

/// What became of a recording.
struct RecordingSummary {
    WrittenCounts written;
    std::uint64_t dropped = 0;
    std::vector<FrameCounts> cameras{};
    std::size_t memory_bytes = 0;     ///< for events that wait to be written
    std::size_t most_used_bytes = 0;  ///< of it, ever
};

struct RecorderOptions {
    RecordFolder::Options folder{};
    std::chrono::seconds segment{60};
    /// Nothing is written until a trigger; what came so long before it is written then. 0: all is.
    std::chrono::seconds pre_trigger{0};
    std::chrono::seconds after_trigger{
        0};  ///< ends so long after the newest trigger; 0: never; with pre_trigger only
    RecordConfig::Trigger trigger_by = RecordConfig::Trigger::kSignal;
    RecordIntakeOptions intake{};
    FrameRecorderOptions frames{};
    std::atomic<bool>* trigger = nullptr;  ///< set from outside, reset here; null: nobody does
};

/// Records cameras, CAN and what is published into LCM logs, beside a run and without slowing it.
/// Its thread, named `record`, writes; it and those that compress run when nobody else wants the
/// CPU. Says as events when it starts, stops, fails and leaves something out. Takes no memory after
/// Open.
class Recorder {
 public:
    /// `clock`, `events`, the cameras and what is referred to by the options must outlive it. The
    /// error names the folder or key that is wrong.
    static hal::Checked<std::unique_ptr<Recorder>> Open(const RecorderOptions& options,
                                                        const drivers::RecordedRig& rig,
                                                        std::vector<RecordedCamera> cameras,
                                                        hal::Clock& clock, EventQueue& events);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// READY: recording begins. `origin`: moment of the clock that is moment 0 of the frames. Again
    /// when that slips.
    void Start(hal::Instant origin);
    /// Writes what has come before the last trigger and from then on. Any thread.
    void Trigger() { triggered_ = true; }
    /// What happened: cameras that are lost, or have any fault, trigger where the options say so.
    /// Any thread.
    void Note(const hal::Event& event) {
        if (Triggers(event.code)) Trigger();
    }
    /// For what is to be recorded. Any thread.
    [[nodiscard]] RecordIntake& intake() { return intake_; }
    /// Says that the recording ends; then Finish. Once.
    void Stop(std::string_view why);
    /// Writes what is left and ends the threads. Once.
    void Finish();

    /// Any thread.
    [[nodiscard]] hal::RecordingHealth Level() const;
    /// After Finish. Takes memory.
    [[nodiscard]] RecordingSummary Summarise() const;

 private:
    [[nodiscard]] bool Triggers(hal::EventCode code) const;

    Recorder(const RecorderOptions& options, RecordFolder folder, const drivers::RecordedRig& rig,
             std::vector<RecordedCamera> cameras, hal::Clock& clock, EventQueue& events);

    void Work();
    void WaitForTrigger();
    void WriteNext();
    void WaitForSpace();
    bool Write(const RecordedEvent& event);
    void NoteTrigger();
    void Arm();
    void Fail(const hal::EventText& why);
    void Tell(hal::EventCode code, std::string_view subject, std::string_view text);
    void WatchEpisode();

    const RecorderOptions options_;
    hal::Clock& clock_;
    EventQueue& events_;
    RecordIntake intake_;
    RecordWriter writer_;
    FrameRecorder frames_;
    bool started_ = false;
    std::atomic<hal::RecordingState> state_;
    std::atomic<bool> triggered_{false};
    std::atomic<bool> finishing_{false};
    // The thread's.
    bool begun_ = false;         // the writer knows when this recording began
    bool announced_ = false;     // that it is being written
    bool failure_told_ = false;  // since it was announced last
    std::int64_t trigger_us_ = 0;
    std::uint64_t dropped_before_ = 0;
    hal::Instant quiet_since_{};
    hal::Instant retry_at_{};
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace hitchview::app
