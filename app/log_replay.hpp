#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/config.hpp"
#include "app/frame_synchronizer.hpp"
#include "app/log_merge.hpp"
#include "app/log_set_former.hpp"
#include "app/log_timeline.hpp"
#include "drivers/lcm_log_camera.hpp"
#include "drivers/lcm_log_can_bus.hpp"
#include "hal/blocking_ring.hpp"
#include "hal/camera.hpp"

namespace hitchview::app {

/// One camera of a recording as a rig has it.
struct LogCamera {
    LogCameraConfig config{};
    std::string name{};
    drivers::LcmLogCamera* source = nullptr;  ///< told what is wanted
    hal::Camera* camera = nullptr;            ///< gives it
    algo::Unit unit = algo::Unit::kTractor;
    std::size_t index_in_unit = 0;
};

/// Frame sets of recordings. A thread of its own (`src-log`) reads each recording once from its
/// first event on, forms the sets from the frames' moments alone (see LogSetFormer) and tells the
/// cameras which frames are wanted; it waits when it is kSetsAhead sets ahead. The cameras fetch
/// and decode them on theirs. A frame whose picture is damaged is a missing camera of its set.
/// CAN frames go to the bus on the way.
class LogReplay final : public FrameSynchronizer {
 public:
    static constexpr std::size_t kSetsAhead = 4;
    /// Pictures of another kind in a row that end a replay; fewer are damage.
    static constexpr int kMostOthers = 30;
    static constexpr std::size_t kMostEarlyCanFrames = 256;
    static constexpr int kSurelyPastEnd = 16;  ///< events in a row

    /// Begins to read. Cameras and bus (null: none) must outlive it, `cameras` in the order of the
    /// rig. A recording that cannot be read, or cannot go on, ends with kFailed and a word on
    /// stderr.
    LogReplay(const RigConfig& config, hal::Instant period, std::vector<LogCamera> cameras,
              drivers::LcmLogCanBus* can_bus);
    ~LogReplay() override;
    LogReplay(const LogReplay&) = delete;
    LogReplay& operator=(const LogReplay&) = delete;

 private:
    struct Seen {
        std::uint32_t frames = 0;
        int others = 0;  ///< pictures of another kind, in a row
    };

    // The reader's thread.
    void Work();
    void Read();
    [[nodiscard]] bool IsPastEnd(std::int64_t utime_us);
    [[nodiscard]] bool Take(const LogMerge::Event& event);
    [[nodiscard]] bool TakeFrame(std::size_t camera, const LogMerge::Event& event);
    [[nodiscard]] bool IsOtherRig(const drivers::LcmLogEvent& event);
    void TakeCanFrame(const drivers::LcmLogEvent& event);
    void HandOverCanFrames();
    [[nodiscard]] bool IsOther(std::size_t camera, const drivers::LoggedImage& image,
                               std::int64_t utime_us);
    void Say(const std::string& failure);
    [[nodiscard]] bool HandOver();

    // The run loop's.
    hal::Result<FrameSet> DoWaitSet() override;
    hal::Result<hal::FrameLease> WaitFrame(const LogCamera& camera) const;

    const LogConfig config_;
    std::vector<LogCamera> cameras_;
    std::vector<Seen> seen_;
    drivers::LcmLogCanBus* can_bus_;
    std::vector<hal::CanFrame> early_can_;  ///< that came before the first picture, the newest
    LogTimeline timeline_;
    LogSetFormer former_;
    int past_end_ = 0;  ///< events in a row
    std::atomic<bool> stop_{false};
    std::atomic<bool> failed_{false};
    LogMerge recordings_;
    hal::BlockingRing<LoggedSet, kSetsAhead> sets_;
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace hitchview::app
