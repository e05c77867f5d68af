#pragma once

#include "algo/camera_frame.hpp"
#include "algo/composition.hpp"
#include "algo/task_runner.hpp"

namespace hitchview::algo {

/// Frame sets in, compositions out, one for each set and in their order. Returned compositions are
/// borrowed until the next call.
class VertexMotion {
 public:
    virtual ~VertexMotion() = default;

    /// Before the first step: looks at one frame set to lay the views out on the canvas. True once
    /// that is done; else try the next set.
    virtual bool Prime(const RigFrames& frames, TaskRunner& runner) = 0;
    /// One frame set in; empty while the composition of the first set is not known yet.
    virtual const Composition* Step(const RigFrames& frames, TaskRunner& runner) = 0;
    /// Asks the next step to leave out what one frame can do without: matching between the units.
    /// False where it does everything all the same.
    virtual bool LightenNextStep() { return false; }
    /// After the last set: the compositions held back, one per call, then empty.
    virtual const Composition* Flush() = 0;
    /// The next step is the first one; the layout stays.
    virtual void Reset() = 0;
};

}  // namespace hitchview::algo
