#include "app/recorded_frame_synchronizer.hpp"

#include <algorithm>

namespace hitchview::app {

hal::Result<hal::FrameLease> RecordedFrameSynchronizer::WaitFrame(hal::Camera& camera) const {
    constexpr std::chrono::milliseconds kPatience{1000};
    constexpr int kTries = 60;  // a recording on a slow disk is waited for
    for (int i = 0; i < kTries; ++i) {
        auto frame = camera.WaitFrame(kPatience);
        if (frame || frame.error() != hal::Error::kTimeout) return frame;
    }
    return hal::Error::kTimeout;
}

/// Damaged, or gone and to be had again.
bool RecordedFrameSynchronizer::IsMissing(hal::Error error, hal::Camera& camera) {
    if (error == hal::Error::kCorrupted) return true;
    return error == hal::Error::kDisconnected && camera.Reopen().ok();
}

hal::Result<FrameSet> RecordedFrameSynchronizer::DoWaitSet() {
    FrameSet set;
    set.sequence = next_sequence_++;
    int index = 0;
    for (const algo::Unit unit : algo::kUnits) {
        for (std::size_t i = 0; i < cameras_[unit].size(); ++i, ++index) {
            auto frame = WaitFrame(*cameras_[unit][i]);
            if (!frame) {
                if (!IsMissing(frame.error(), *cameras_[unit][i])) return frame.error();
                set.cameras_missing |= 1U << index;
                continue;
            }
            set.leases[unit][i] = std::move(*frame);
        }
    }
    set.FindMoments();
    return set;
}

}  // namespace hitchview::app
