#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// Pictures of a recording, one after another. Thread: one, from opening to destruction.
class ReplaySource {
 public:
    virtual ~ReplaySource() = default;

    /// NV12, full range, even size; constant.
    [[nodiscard]] const hal::FrameFormat& format() const { return format_; }
    /// Nominal frames per second as the file states it; 0 if it states none.
    [[nodiscard]] double rate_hz() const { return rate_hz_; }

    /// Decodes the next picture into `nv12`, FrameBytes(format()) long.
    /// kEndOfStream: there are no more. kCorrupted: this one is damaged or of another size; the
    /// next may be good.
    hal::Result<hal::Done> Read(std::span<std::uint8_t> nv12) {
        HV_EXPECT(nv12.size() == hal::FrameBytes(format_));
        return DoRead(nv12);
    }

 protected:
    ReplaySource(int width_px, int height_px, double rate_hz)
        : format_{.width_px = width_px & ~1, .height_px = height_px & ~1}, rate_hz_(rate_hz) {}

 private:
    virtual hal::Result<hal::Done> DoRead(std::span<std::uint8_t> nv12) = 0;

    hal::FrameFormat format_;
    double rate_hz_;
};

/// Every frame of a video file, in the order of decoding; container timestamps are ignored.
hal::Checked<std::unique_ptr<ReplaySource>> OpenVideoSource(const std::string& path);

/// Pictures named by a pattern such as `front/%05d.jpg` (numbers without a gap, from 0 or 1), or
/// all pictures of a folder in natural order of their names (2.png before 10.png).
hal::Checked<std::unique_ptr<ReplaySource>> OpenImageSource(const std::string& path);

}  // namespace hitchview::drivers
