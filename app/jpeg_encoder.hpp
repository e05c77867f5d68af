#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "algo/task_runner.hpp"
#include "app/jpeg_quality_governor.hpp"
#include "app/jpeg_slice.hpp"
#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Compresses I420 frames of one size to JPEG within a byte budget, in slices that threads can
/// share. All memory is taken at construction. Thread: one at a time.
///
/// A picture beyond the budget is compressed once more at the lower quality that the governor
/// gives, and if that is not enough (noise from edge to edge) a last time at kLastResortQuality:
/// display units with the kernel's own receive buffer would not get a larger message at all.
class JpegEncoder {
 public:
    static constexpr int kLastResortQuality = 3;

    /// `format`: I420, full range, even sides in [2, 16384].
    JpegEncoder(const hal::FrameFormat& format, const JpegQualityGovernorOptions& options);

    /// Slices of a picture that is high enough. The same on any number of threads, and so is the
    /// JPEG.
    static constexpr int kSlices = 4;

    /// The frame must have the format given at construction. The bytes are valid until the next
    /// call. kTooLarge: beyond the budget even at the last resort.
    hal::Result<std::span<const std::uint8_t>> Encode(const hal::FrameView& frame,
                                                      algo::TaskRunner& runner);
    /// The same, all of it on the calling thread.
    hal::Result<std::span<const std::uint8_t>> Encode(const hal::FrameView& frame);

    /// Of the next picture.
    [[nodiscard]] int quality() const { return governor_.quality(); }
    /// Of the newest picture; 0 before the first.
    [[nodiscard]] int newest_quality() const { return newest_quality_; }

 private:
    std::span<const std::uint8_t> Compress(const hal::FrameView& frame, int quality,
                                           algo::TaskRunner& runner);

    hal::FrameFormat format_;
    JpegQualityGovernor governor_;
    std::vector<std::unique_ptr<JpegSlice>> slices_;
    int newest_quality_ = 0;
    std::size_t slice_bytes_;  ///< between the starts of two slices in output_
    std::vector<std::uint8_t> output_;
    std::vector<std::span<std::uint8_t>> bands_;
};

}  // namespace hitchview::app
