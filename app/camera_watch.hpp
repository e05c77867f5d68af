#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/camera_judge.hpp"
#include "app/event_queue.hpp"
#include "app/frame_set.hpp"
#include "app/picture_signs.hpp"
#include "hal/clock.hpp"

namespace hitchview::app {

/// A camera that is watched.
struct WatchedPicture {
    std::string name;
    algo::Unit unit = algo::Unit::kTractor;
    std::size_t index_in_unit = 0;
};

/// Judges every camera by each frame set, so that old or empty pictures are not shown as if they
/// were live, and tells the rest of the world what is wrong. See docs/safety.md. Takes no memory
/// after construction. Thread: pipeline.
class CameraWatch {
 public:
    /// Devices of live cameras tell themselves why they give nothing, by 30 periods of silence; what
    /// none has told by then is told here.
    static constexpr hal::Instant LivePatience(hal::Instant period) {
        return std::chrono::milliseconds(500) +
               std::max<hal::Instant>(std::chrono::seconds(1), 30 * period);
    }

    /// `cameras` in the order of the bits of FrameSet::cameras_missing; `events` and `clock` must
    /// outlive it. `patience`: before it is told that a camera is lost, beside what its state
    /// takes.
    CameraWatch(std::vector<WatchedPicture> cameras, hal::Instant period, EventQueue& events,
                const hal::Clock& clock, hal::Instant patience = {});

    /// Sets camera_states; gives back the frames that must not be shown, whose cameras are missing
    /// then.
    void Look(FrameSet& set);
    /// What was seen counts as nothing.
    void Reset();

 private:
    struct Camera {
        Camera(WatchedPicture watched, hal::Instant period)
            : picture(std::move(watched)), judge(period) {}

        WatchedPicture picture;
        CameraJudge judge;
        std::optional<hal::FrameHeader> newest{};
        int sets_since_disorder = kDisorderLasts;
        hal::CameraState told = hal::CameraState::kGood;
        hal::Instant told_at{};
        std::optional<hal::Instant> lost_at{};
        bool device_told = false;  ///< whoever captures its frames has said that it is lost
        std::optional<hal::Instant> had_since{};  ///< and had it again, while it was still lost
    };

    /// A stamp that goes back leaves doubt about the ones around it. Sets.
    static constexpr int kDisorderLasts = 4;

    [[nodiscard]] hal::Instant MomentOf(const FrameSet& set) const;
    CameraSigns Look(std::size_t index, const FrameSet& set, hal::Instant moment);
    void Decide(std::size_t index, FrameSet& set, bool too_old);
    void Tell(Camera& camera, hal::CameraState state, bool device_gone);
    void NoteDevice(Camera& camera, hal::CameraState state, bool device_gone, hal::Instant now);
    void Put(const Camera& camera, hal::CameraState state, hal::Instant now);
    [[nodiscard]] hal::FrameLease& LeaseOf(FrameSet& set, std::size_t index) const;
    [[nodiscard]] const hal::FrameLease& LeaseOf(const FrameSet& set, std::size_t index) const;

    std::vector<Camera> cameras_;
    hal::Instant period_;
    EventQueue& events_;
    const hal::Clock& clock_;
    const hal::Instant patience_;
    PictureSigns pictures_;
};

}  // namespace hitchview::app
