#pragma once

#include "app/frame_set.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Makes frame sets of the cameras' frames. Thread: the run loop's.
class FrameSynchronizer {
 public:
    virtual ~FrameSynchronizer() = default;

    /// Blocks until there is a set. Its sequence steps by one, more where sets are missing.
    /// kEndOfStream: a recording is over. Other errors: the camera that failed.
    hal::Result<FrameSet> WaitSet() { return DoWaitSet(); }

 private:
    virtual hal::Result<FrameSet> DoWaitSet() = 0;
};

}  // namespace hitchview::app
