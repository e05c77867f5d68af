#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "app/camera_pace.hpp"
#include "app/set_rule.hpp"
#include "hal/frame_pool.hpp"

namespace hitchview::app {

/// What became of the frames that one camera delivered.
struct InboxCounts {
    std::uint64_t put = 0;
    std::uint64_t taken = 0;       ///< by a set
    std::uint64_t superseded = 0;  ///< two newer ones came before a set was made
    std::uint64_t set_aside = 0;   ///< no set could have them: see SetRule
    std::uint64_t disordered = 0;  ///< their stamps went back
    std::uint64_t pending = 0;     ///< wait for a set; the five are all that were put in
};

/// The two newest frames of each camera, from the capture threads to the one that makes sets of
/// them. An older frame goes back to its camera when a newer one comes, and so does one whose stamp
/// is not after that of the frame before. Takes no memory.
class FrameInbox {
 public:
    /// `cameras`: at most kMaxCameras. `now`: when they were opened.
    FrameInbox(std::size_t cameras, hal::Instant now) : cameras_(cameras) {
        for (Place& place : places_) place.heard_at = now;
    }

    /// Capture threads.
    void Put(std::size_t camera, hal::FrameLease frame, hal::Instant now);
    /// A camera is connected when it is opened. Capture threads.
    void SetConnected(std::size_t camera, bool connected);

    /// Gives back what it holds, and takes no more: before the cameras go.
    void Close();

    /// What the thread that makes sets sees and does while nobody puts anything in.
    class Visit {
     public:
        explicit Visit(FrameInbox& inbox) : inbox_(inbox), lock_(inbox.mutex_) {}

        /// A camera that has been silent for `patience` is not awaited.
        [[nodiscard]] PendingFrames Pending(hal::Instant now, hal::Instant patience) const;
        /// When any camera gave a frame with a new stamp last, or was opened.
        [[nodiscard]] hal::Instant heard_at() const;
        /// Cameras whose device is gone, which CaptureThread has told.
        [[nodiscard]] CameraMask Gone() const;
        /// Cameras that gave frames which were set aside, or went back in time, since the call
        /// before.
        struct Refused {
            CameraMask late;
            CameraMask disordered;
        };
        Refused TakeRefused();
        /// Frames of all cameras that came and were in no set.
        [[nodiscard]] std::uint64_t Unused() const;
        /// The head of a camera that has one.
        hal::FrameLease Take(std::size_t camera);
        /// Heads.
        void SetAside(const CameraMask& cameras);
        /// Waits until something is put in, or for `timeout`.
        void Wait(std::chrono::nanoseconds timeout);

     private:
        FrameInbox& inbox_;
        std::unique_lock<std::mutex> lock_;
    };

    [[nodiscard]] InboxCounts counts(std::size_t camera) const;
    [[nodiscard]] CameraPace pace(std::size_t camera) const;

 private:
    struct Place {
        std::array<hal::FrameLease, 2> frames;  ///< the head and the one after it
        hal::Instant heard_at{};
        bool connected = true;
        InboxCounts counts;
        CameraPace pace;
        hal::Instant newest_stamp = hal::Instant::min();
    };

    const std::size_t cameras_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::array<Place, kMaxCameras> places_;
    Visit::Refused refused_;
    bool closed_ = false;
};

}  // namespace hitchview::app
