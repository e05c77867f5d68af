#pragma once

#include "app/board.hpp"
#include "app/frame_set.hpp"

namespace hitchview::app {

/// Makes frame sets of the cameras' frames. Recordings and simulations: frame i of every camera
/// forms set i, none is lost; the shortest recording ends the run. Thread: the run loop's.
class FrameSynchronizer {
 public:
    explicit FrameSynchronizer(Board::Cameras& cameras) : cameras_(cameras) {}

    /// A damaged frame is a missing camera of that set.
    /// kEndOfStream: a camera has no more frames. Other errors: the camera that failed.
    hal::Result<FrameSet> WaitSet();

 private:
    hal::Result<hal::FrameLease> WaitFrame(hal::Camera& camera) const;

    Board::Cameras& cameras_;
    std::uint32_t next_sequence_ = 0;
};

}  // namespace hitchview::app
