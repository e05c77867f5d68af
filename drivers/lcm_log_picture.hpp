#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "drivers/lcm_log_messages.hpp"
#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

class FrameJpegDecoder;

/// What the pictures of one camera in a log are, and what frames they become.
struct LcmLogPictureKind {
    hal::FrameFormat format{};  ///< of the frames: raw pictures stay as they are, JPEG becomes NV12
    bool compressed = false;    ///< JPEG

    friend bool operator==(const LcmLogPictureKind&, const LcmLogPictureKind&) = default;
};

/// Empty for pixels that are none of MJPG, UYVY, YUYV, NV12 and GREY, and for a size that no frame
/// has: odd, or outside [16, 8192].
std::optional<LcmLogPictureKind> PictureKindOf(const LoggedImage& image);

/// Makes frames of one camera's pictures. Memory is taken at construction only. Thread: one at a
/// time.
class LcmLogPictureDecoder {
 public:
    explicit LcmLogPictureDecoder(const LcmLogPictureKind& kind);
    ~LcmLogPictureDecoder();
    LcmLogPictureDecoder(const LcmLogPictureDecoder&) = delete;
    LcmLogPictureDecoder& operator=(const LcmLogPictureDecoder&) = delete;

    /// `frame`: FrameBytes of the kind's format. kCorrupted: of another kind, too short or damaged;
    /// `frame` then holds part of a picture.
    hal::Result<hal::Done> Decode(const LoggedImage& image, std::span<std::uint8_t> frame);

 private:
    LcmLogPictureKind kind_;
    std::unique_ptr<FrameJpegDecoder> jpeg_;  ///< compressed pictures only
};

}  // namespace hitchview::drivers
