#include "app/recorder.hpp"

#include <limits>
#include <utility>

#include "app/thread_schedule.hpp"

namespace hitchview::app {
namespace {

using hal::EventCode;
using hal::EventText;
using hal::RecordingState;
using std::chrono::milliseconds;

constexpr milliseconds kBeat{50};

RecordRing::WhenFull WhenFullOf(const RecordIntake& intake) {
    return intake.lossless() ? RecordRing::WhenFull::kWait : RecordRing::WhenFull::kRefuse;
}

std::int64_t Microseconds(std::chrono::microseconds time) {
    return time.count();
}

/// Empty, or why the frames do not fit.
std::string Problem(const RecorderOptions& options, const std::vector<RecordedCamera>& cameras) {
    std::size_t largest = 0;
    for (const RecordedCamera& camera : cameras)
        largest = std::max(largest, hal::FrameBytes(camera.format));
    constexpr std::size_t kFramesInMemory = 4;
    const std::size_t needed = kFramesInMemory * largest;
    if (!options.frames.raw || options.intake.memory_bytes >= needed) return "";
    return "record.memory_mb is " + std::to_string(options.intake.memory_bytes >> 20) +
           ", must be at least " + std::to_string((needed >> 20) + 1) + " for these raw frames";
}

}  // namespace

hal::Checked<std::unique_ptr<Recorder>> Recorder::Open(const RecorderOptions& options,
                                                       const drivers::RecordedRig& rig,
                                                       std::vector<RecordedCamera> cameras,
                                                       hal::Clock& clock, EventQueue& events) {
    if (std::string problem = Problem(options, cameras); !problem.empty()) return problem;
    auto folder = RecordFolder::Open(options.folder);
    if (!folder) return folder.error();
    return std::unique_ptr<Recorder>(
        new Recorder(options, std::move(folder.value()), rig, std::move(cameras), clock, events));
}

Recorder::Recorder(const RecorderOptions& options, RecordFolder folder,
                   const drivers::RecordedRig& rig, std::vector<RecordedCamera> cameras,
                   hal::Clock& clock, EventQueue& events)
    : options_(options),
      clock_(clock),
      events_(events),
      intake_(options.intake, clock, events),
      writer_(std::move(folder), rig, {.segment = options.segment, .live = options.intake.live},
              clock),
      frames_(std::move(cameras), options.frames, intake_),
      state_(RecordingState::kOn) {
    intake_.ring().SetWhenFull(WhenFullOf(intake_));
    if (options.pre_trigger.count() > 0) Arm();
    thread_ = std::thread([this] { Work(); });
}

Recorder::~Recorder() {
    Finish();
}

bool Recorder::Triggers(hal::EventCode code) const {
    using By = RecordConfig::Trigger;
    switch (options_.trigger_by) {
        case By::kSignal:
            return false;
        case By::kCameraLost:
            return code == hal::EventCode::kCameraLost;
        case By::kCameraFault:
            return code >= hal::EventCode::kCameraLost && code <= hal::EventCode::kCameraDirty &&
                   code != hal::EventCode::kCameraBack;
    }
    return false;
}

void Recorder::Start(hal::Instant origin) {
    intake_.Start(origin);
    if (!std::exchange(started_, true)) frames_.Start();
}

void Recorder::Stop(std::string_view why) {
    if (state_ == RecordingState::kOn) Tell(EventCode::kRecordingStopped, {}, why);
}

void Recorder::Finish() {
    frames_.Finish();
    intake_.Stop();
    finishing_ = true;
    intake_.ring().Close();
    if (thread_.joinable()) thread_.join();
}

void Recorder::Work() {
    NameThisThread("record");
    RunInBackground();
    while (!intake_.ring().finished()) {
        switch (state_) {
            case RecordingState::kArmed:
                WaitForTrigger();
                break;
            case RecordingState::kStopped:
                WaitForSpace();
                break;
            default:
                WriteNext();
                break;
        }
        WatchEpisode();
    }
    writer_.Close();
}

void Recorder::Arm() {
    intake_.ring().SetWhenFull(RecordRing::WhenFull::kDropOldest);
    begun_ = announced_ = false;
    state_ = RecordingState::kArmed;
}

/// What triggered before is over with.
void Recorder::NoteTrigger() {
    const bool from_outside = options_.trigger != nullptr && options_.trigger->exchange(false);
    if (triggered_.exchange(false) || from_outside) trigger_us_ = intake_.ring().newest_utime_us();
}

void Recorder::WaitForTrigger() {
    RecordRing& ring = intake_.ring();
    trigger_us_ = 0;
    NoteTrigger();
    if (trigger_us_ == 0) {
        if (finishing_) ring.DropBefore(std::numeric_limits<std::int64_t>::max());
        return std::this_thread::sleep_for(kBeat);
    }
    ring.SetWhenFull(WhenFullOf(intake_));
    ring.DropBefore(trigger_us_ - Microseconds(options_.pre_trigger));
    state_ = RecordingState::kOn;
}

void Recorder::WriteNext() {
    NoteTrigger();
    const auto event = intake_.ring().Front(kBeat);
    bool written = true;
    bool over = false;
    if (event) {
        written = Write(*event);
        over = options_.pre_trigger.count() > 0 && options_.after_trigger.count() > 0 &&
               event->utime_us > trigger_us_ + Microseconds(options_.after_trigger);
        intake_.ring().Pop();
    }
    if (!written) return intake_.NoteDropped(1);
    if (const auto beat = writer_.Beat(); !beat) return Fail(beat.error());
    if (!over) return;
    writer_.Close();
    Tell(EventCode::kRecordingStopped, writer_.segment(), "nothing has triggered for long");
    Arm();
}

/// False: it failed, and the event is not in the recording.
bool Recorder::Write(const RecordedEvent& event) {
    if (!std::exchange(begun_, true)) writer_.Begin(event.utime_us);
    if (const auto written = writer_.Append(event); !written) {
        Fail(written.error());
        return false;
    }
    if (!std::exchange(announced_, true)) {
        failure_told_ = false;
        Tell(EventCode::kRecordingStarted, writer_.segment(), "recording");
    }
    return true;
}

void Recorder::Fail(const hal::EventText& why) {
    if (!std::exchange(failure_told_, true))
        Tell(EventCode::kRecordingFailed, writer_.segment(), why.view());
    announced_ = false;
    retry_at_ = {};
    state_ = RecordingState::kStopped;
}

/// What comes meanwhile is lost, so that nobody waits and the newest is recorded afterwards.
void Recorder::WaitForSpace() {
    constexpr hal::Instant kRetry = std::chrono::seconds(2);
    if (intake_.ring().Front(kBeat)) {
        intake_.ring().Pop();
        intake_.NoteDropped(1);
    }
    const hal::Instant now = clock_.Now();
    if (retry_at_.count() == 0) retry_at_ = now + kRetry;
    if (now < retry_at_) return;
    retry_at_ = now + kRetry;
    if (writer_.CanBegin()) state_ = RecordingState::kOn;
}

void Recorder::Tell(hal::EventCode code, std::string_view subject, std::string_view text) {
    events_.Put({.code = code, .when = intake_.Now(), .subject = subject, .text = text});
}

/// Losses belong to one episode until none has happened for a while.
void Recorder::WatchEpisode() {
    constexpr hal::Instant kQuiet = std::chrono::seconds(2);
    const hal::Instant now = clock_.Now();
    const std::uint64_t dropped = intake_.dropped();
    if (dropped != std::exchange(dropped_before_, dropped)) quiet_since_ = now;
    if (now - quiet_since_ > kQuiet) intake_.EndEpisode();
}

hal::RecordingHealth Recorder::Level() const {
    return {.state = state_,
            .recorded_bytes = writer_.counts().bytes,
            .dropped = intake_.dropped(),
            .disk_free_bytes = writer_.free_bytes()};
}

RecordingSummary Recorder::Summarise() const {
    return {.written = writer_.counts(),
            .dropped = intake_.dropped(),
            .cameras = frames_.counts(),
            .memory_bytes = intake_.ring().capacity_bytes(),
            .most_used_bytes = intake_.ring().most_used_bytes()};
}

}  // namespace hitchview::app
