#pragma once

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "drivers/replay_source.hpp"
#include "hal/blocking_ring.hpp"
#include "hal/camera.hpp"

namespace hitchview::drivers {

struct ReplayCameraOptions {
    std::string name;  ///< its thread is called `src-<name>`
    double rate_hz =
        0;          ///< nominal frames per second; 0: what the file states, 30 if it states none
    int slots = 8;  ///< frames decoded ahead or lent. [4, 64]
};

/// Camera over a recording: NV12, full range, BT.601 as in JPEG. Odd sizes lose their last row or
/// column. Frame i has sequence i and was captured at i periods. No frame is lost however slow the
/// reader is: the decoder waits. A damaged frame answers kCorrupted and leaves a gap in the
/// sequence. Thread: its own decodes; one other calls WaitFrame. Leases must not outlive the
/// camera.
class ReplayCamera final : public hal::Camera, private hal::FrameOwner {
 public:
    /// `path`: a folder of pictures, a pattern with one `%0Nd`, or a video file.
    static hal::Checked<std::unique_ptr<ReplayCamera>> Open(const std::string& path,
                                                            const ReplayCameraOptions& options);
    ~ReplayCamera() override;

    [[nodiscard]] double rate_hz() const { return rate_hz_; }

 private:
    struct Decoded {
        hal::FramePool::Slot slot{};
        hal::FrameHeader header;
        hal::Result<hal::Done> outcome = hal::Done{};
    };

    explicit ReplayCamera(const ReplayCameraOptions& options);
    hal::Checked<hal::Done> Start(const std::string& path);
    void TakeMemory(const ReplaySource& source);
    void Decode(ReplaySource& source);

    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_->format(); }
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    void DoReturn(int slot) override;
    [[nodiscard]] hal::PoolLevel DoPool() const override;

    ReplayCameraOptions options_;
    double rate_hz_ = 0;
    std::unique_ptr<hal::FramePool> pool_;
    std::vector<hal::FramePool::Slot> slots_;  ///< by index: every slot of the pool, for ever ours
    hal::BlockingRing<hal::FramePool::Slot, 64> free_;
    hal::BlockingRing<Decoded, 64> decoded_;
    std::thread thread_;
};

}  // namespace hitchview::drivers
