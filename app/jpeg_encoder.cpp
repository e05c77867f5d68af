#include "app/jpeg_encoder.hpp"

#include <algorithm>

#include "app/jpeg_join.hpp"
#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

constexpr int kLongestSide_px = 16384;
constexpr int kLargestInterval = 65535;  // of restarts, in blocks: the header has 16 bits for it

const hal::FrameFormat& Expected(const hal::FrameFormat& format) {
    const auto is_side = [](int px) { return px >= 2 && px <= kLongestSide_px && px % 2 == 0; };
    HV_EXPECT(is_side(format.width_px) && is_side(format.height_px));
    HV_EXPECT(format.pixel_format == hal::PixelFormat::kI420 && format.range == hal::Range::kFull);
    return format;
}

int CeilOf(int value, int unit) {
    return (value + unit - 1) / unit;
}

/// All slices have the rows of blocks that the restart interval says, but for the last.
std::vector<std::unique_ptr<JpegSlice>> MakeSlices(const hal::FrameFormat& format) {
    const int blocks_across = CeilOf(format.width_px, JpegSlice::kBlockRows);
    const int block_rows = CeilOf(format.height_px, JpegSlice::kBlockRows);
    const int rows_each =
        std::min(CeilOf(block_rows, JpegEncoder::kSlices), kLargestInterval / blocks_across);
    std::vector<std::unique_ptr<JpegSlice>> slices;
    for (int row = 0; row < block_rows; row += rows_each) {
        const int first = row * JpegSlice::kBlockRows;
        const int rows = std::min(rows_each * JpegSlice::kBlockRows, format.height_px - first);
        slices.push_back(
            std::make_unique<JpegSlice>(format, first, rows, rows_each * blocks_across));
    }
    return slices;
}

}  // namespace

JpegEncoder::JpegEncoder(const hal::FrameFormat& format, const JpegQualityGovernorOptions& options)
    : format_(Expected(format)),
      governor_(options),
      slices_(MakeSlices(format)),
      slice_bytes_(slices_.front()->LargestBytes()),
      output_(slice_bytes_ * slices_.size()),
      bands_(slices_.size()) {}

hal::Result<std::span<const std::uint8_t>> JpegEncoder::Encode(const hal::FrameView& frame) {
    algo::SerialRunner runner;
    return Encode(frame, runner);
}

hal::Result<std::span<const std::uint8_t>> JpegEncoder::Encode(const hal::FrameView& frame,
                                                               algo::TaskRunner& runner) {
    HV_EXPECT(frame.format == format_);
    const int quality = governor_.quality();
    std::span<const std::uint8_t> jpeg = Compress(frame, quality, runner);
    governor_.Note(jpeg.size());
    if (governor_.quality() < quality) jpeg = Compress(frame, governor_.quality(), runner);
    if (!governor_.IsWithinBudget(jpeg.size())) jpeg = Compress(frame, kLastResortQuality, runner);
    if (!governor_.IsWithinBudget(jpeg.size())) return hal::Error::kTooLarge;
    return jpeg;
}

std::span<const std::uint8_t> JpegEncoder::Compress(const hal::FrameView& frame, int quality,
                                                    algo::TaskRunner& runner) {
    newest_quality_ = quality;
    runner.Run(static_cast<int>(slices_.size()), [&](int i) {
        const auto slice = static_cast<std::size_t>(i);
        bands_[slice] = slices_[slice]->Compress(
            frame, quality, std::span(output_).subspan(slice * slice_bytes_, slice_bytes_));
    });
    return JoinJpegBands(output_, bands_, format_.height_px);
}

}  // namespace hitchview::app
