#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "app/set_rule.hpp"
#include "drivers/lcm_log_camera.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// A frame of a recording, not fetched yet.
struct LoggedFrame {
    std::size_t camera = 0;
    hal::FrameHeader header{};
    drivers::LcmLogPlace place{};
};

/// Frames of a recording that make a set.
struct LoggedSet {
    std::uint32_t sequence = 0;
    std::array<std::optional<LoggedFrame>, kMaxCameras> frames{};
};

/// Makes sets of the frames of a recording by SetRule, as if each frame came at the moment of its
/// capture. The sets depend on what is in the recording alone: neither on when it is read nor on
/// the order in which cameras that are out of step by less than kDisorder were written. So a camera
/// is awaited exactly if it will give a frame in time.
///
/// Memory: at most kMostEarly frames of each camera, without their pictures; a camera that is
/// further ahead of the others gets sets without them. Thread: one.
class LogSetFormer {
 public:
    static constexpr hal::Instant kDisorder = std::chrono::milliseconds(500);
    static constexpr std::size_t kMostEarly = 128;

    /// As SetRule. `cameras`: at most kMaxCameras.
    LogSetFormer(std::size_t cameras, hal::Instant period, hal::Instant tolerance);

    /// Frames of one camera that are not newer than one before it are left out.
    void Add(const LoggedFrame& frame);
    /// No further frame will come.
    void Finish();
    /// The next set that is known, in order.
    std::optional<LoggedSet> Take();

 private:
    struct Camera {
        std::deque<LoggedFrame> early;  ///< in order of time, waiting for their moment
        std::array<std::optional<LoggedFrame>, 2> pending;  ///< the head and the one after it
        std::optional<hal::Instant> newest;                 ///< that has come
    };

    [[nodiscard]] Camera* Earliest();
    [[nodiscard]] bool IsFull() const;
    void Release(Camera& camera);
    void Judge(hal::Instant now);
    [[nodiscard]] PendingFrames Pending() const;
    [[nodiscard]] bool HasPending() const;
    void Drop(const CameraMask& heads);
    void Make(const CameraMask& heads);
    [[nodiscard]] std::uint32_t Number(hal::Instant moment);

    hal::Instant period_;
    SetRule rule_;
    std::vector<Camera> cameras_;
    hal::Instant newest_read_ = hal::Instant::min();
    hal::Instant now_ = hal::Instant::min();
    hal::Instant ask_again_at_{};
    std::deque<LoggedSet> sets_;
    std::optional<hal::Instant> newest_set_;
    std::uint32_t sequence_ = 0;
};

}  // namespace hitchview::app
