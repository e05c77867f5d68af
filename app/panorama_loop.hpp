#pragma once

#include <atomic>

#include "app/board.hpp"
#include "app/frame_deadlines.hpp"
#include "app/run_loop.hpp"
#include "app/run_outputs.hpp"

namespace hitchview::app {

/// Drives one opened rig from READY to its last panorama; see RunRig. All memory was taken before.
class PanoramaLoop {
 public:
    /// What it works on; all must outlive it.
    struct Parts {
        Board& board;
        algo::VertexMotion& motion;
        Pipeline& pipeline;
        RunOutputs& outputs;
    };
    PanoramaLoop(const Parts& parts, const RunOptions& options, RunSummary& summary);

    hal::Checked<hal::Done> Run(const std::atomic<bool>& stop, const ShownHook& hook);

 private:
    hal::Checked<hal::Done> ShowSets(const std::atomic<bool>& stop, const ShownHook& hook);
    hal::Checked<hal::Done> ShowHeldBack(const ShownHook& hook);
    hal::Checked<hal::Done> Show(const ShownPanorama& shown, const ShownHook& hook);
    void CatchUp();
    bool WaitForTurn(std::uint32_t sequence, hal::Instant asked);
    void CountDeadline();
    [[nodiscard]] bool Limited(std::uint64_t taken) const;

    Parts parts_;
    const RunOptions& options_;
    RunSummary& summary_;
    FrameDeadlines deadlines_;
};

/// What is said of a camera that fails.
std::string CameraFailure(hal::Error error);

}  // namespace hitchview::app
