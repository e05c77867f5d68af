#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/capture_thread.hpp"
#include "app/frame_inbox.hpp"
#include "app/frame_synchronizer.hpp"
#include "app/set_rule.hpp"
#include "app/stage_times.hpp"
#include "hal/clock.hpp"

namespace hitchview::app {

/// One live camera and what it is called.
struct LiveCamera {
    hal::Camera* camera = nullptr;
    std::string name;
    algo::Unit unit = algo::Unit::kTractor;
    std::size_t index_in_unit = 0;
};

/// Since StartCounting.
struct SetCounts {
    std::uint64_t complete = 0;  ///< of all cameras of the rig
    std::uint64_t partial = 0;   ///< of some
    std::uint64_t empty = 0;     ///< of none: nothing to show came for long
    std::uint64_t skipped = 0;   ///< periods that have no set although frames came
};

/// What became of the frames of one live camera since it was opened.
struct LiveCameraSummary {
    std::string name;
    hal::CameraCounts device;
    InboxCounts inbox;                  ///< of those that the device delivered
    std::optional<double> period_ms{};  ///< by the camera's own clock
};

struct LiveSummary {
    SetCounts sets;
    StageTimes spread;  ///< from the oldest to the newest exposure of a set
    std::vector<LiveCameraSummary> cameras;
};

/// Makes frame sets of cameras that run at their own pace: see SetRule. Where no camera gives
/// anything for kPatience periods, sets come without frames at the cameras' pace, so that display
/// units are told. Sets are numbered by the periods between their newest frames: a gap is sets that
/// nobody had time for. Takes no memory after construction.
class LiveFrameSynchronizer final : public FrameSynchronizer {
 public:
    static constexpr int kPatience = 3;  ///< periods after which a silent camera is not awaited

    /// Starts to capture. `cameras`, at most kMaxCameras, `events` and `clock` must outlive it.
    LiveFrameSynchronizer(std::vector<LiveCamera> cameras, EventQueue& events, hal::Clock& clock,
                          hal::Instant period, hal::Instant tolerance);
    ~LiveFrameSynchronizer() override;

    /// The program is ready: sets are counted and numbered anew, whatever it had no time for while
    /// it got ready. What became of the cameras' frames is counted on.
    void StartCounting();
    [[nodiscard]] const SetCounts& counts() const { return counts_; }
    /// Ends the capture. No set may be asked for afterwards.
    void Finish();
    /// After Finish. Takes memory.
    [[nodiscard]] LiveSummary Summarise() const;

 private:
    hal::Result<FrameSet> DoWaitSet() override;
    FrameSet EmptySet(FrameInbox::Visit& visit, hal::Instant now);
    static void NoteMissing(FrameInbox::Visit& visit, FrameSet& set);
    FrameSet TakeSet(FrameInbox::Visit& visit, const CameraMask& taken);
    void Number(const FrameInbox::Visit& visit, FrameSet& set, hal::Instant moment);

    std::vector<LiveCamera> cameras_;
    hal::Clock& clock_;
    hal::Instant period_;
    SetRule rule_;
    FrameInbox inbox_;
    SetCounts counts_;
    StageTimes spread_;
    hal::Instant empty_at_{};  ///< of the newest empty set
    std::uint32_t sequence_ = 0;
    hal::Instant set_due_{};  ///< moment of the next set, where none is skipped
    std::uint64_t unused_ = 0;
    std::vector<std::unique_ptr<CaptureThread>> threads_;  // last: they use the inbox
};

}  // namespace hitchview::app
