#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/lcm_log_picture.hpp"
#include "drivers/lcm_log_window.hpp"
#include "hal/blocking_ring.hpp"
#include "hal/camera.hpp"

namespace hitchview::drivers {

/// Where a message stands in the files of a recording.
struct LcmLogPlace {
    std::size_t file = 0;
    std::uint64_t position_bytes = 0;  ///< of the message's first byte
    std::uint32_t size_bytes = 0;
};

struct LcmLogCameraOptions {
    std::vector<std::filesystem::path> files{};  ///< of the recording, in their order
    LcmLogPictureKind kind{};
    int slots = 8;  ///< frames that may be lent. [1, 64]
};

/// One camera of a recording: who reads the recording tells it which frames are wanted, and where
/// their messages stand; it fetches and decodes them one by one when it is asked. So what nobody
/// wants is never decoded, and a frame takes memory only once it is.
/// Thread: one appends, one other calls WaitFrame. Leases must not outlive the camera.
class LcmLogCamera final : public hal::Camera {
 public:
    static constexpr std::size_t kMostWanted = 32;

    explicit LcmLogCamera(const LcmLogCameraOptions& options);
    ~LcmLogCamera() override;

    /// The next frame. Waits while kMostWanted wait to be fetched; false once closed.
    bool Append(const hal::FrameHeader& header, const LcmLogPlace& place);
    /// No further frame will be wanted. Any thread.
    void Close() { wanted_.Close(); }

 private:
    struct Wanted {
        hal::FrameHeader header{};
        LcmLogPlace place{};
    };

    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return pool_.format(); }
    /// kCorrupted: the message is damaged, gone or of another kind. kEndOfStream: closed, and every
    /// frame was given.
    hal::Result<hal::FrameLease> DoWaitFrame(std::chrono::milliseconds timeout) override;
    [[nodiscard]] hal::PoolLevel DoPool() const override { return pool_.level(); }
    hal::Result<hal::Done> Fetch(const LcmLogPlace& place, std::span<std::uint8_t> frame);
    bool Open(std::size_t file);

    LcmLogCameraOptions options_;
    hal::FramePool pool_;
    LcmLogPictureDecoder decoder_;
    hal::BlockingRing<Wanted, kMostWanted> wanted_;
    std::unique_ptr<LcmLogWindow> window_;  ///< on file open_file_
    std::size_t open_file_ = 0;
    std::vector<std::uint8_t> message_;
};

}  // namespace hitchview::drivers
