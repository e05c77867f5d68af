#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "algo/unit.hpp"
#include "app/frame_synchronizer.hpp"
#include "hal/camera.hpp"

namespace hitchview::app {

/// The cameras of a rig in the order of its file.
using Cameras = algo::PerUnit<std::vector<std::unique_ptr<hal::Camera>>>;

/// Sets of recordings and simulations: frame i of every camera forms set i, none is lost; the
/// shortest recording ends the run. A damaged frame is a missing camera of that set, and so is one
/// of a camera that is gone and can be had again.
class RecordedFrameSynchronizer final : public FrameSynchronizer {
 public:
    explicit RecordedFrameSynchronizer(Cameras& cameras) : cameras_(cameras) {}

 private:
    hal::Result<FrameSet> DoWaitSet() override;
    hal::Result<hal::FrameLease> WaitFrame(hal::Camera& camera) const;
    static bool IsMissing(hal::Error error, hal::Camera& camera);

    Cameras& cameras_;
    std::uint32_t next_sequence_ = 0;
};

}  // namespace hitchview::app
