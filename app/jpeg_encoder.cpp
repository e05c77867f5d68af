#include "app/jpeg_encoder.hpp"

#include <algorithm>
#include <cstring>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

constexpr int kLongestSide_px = 16384;

int RoundUp(int value, int unit) {
    return (value + unit - 1) / unit * unit;
}

/// No JPEG of the format is larger: twice the bytes of its whole blocks, and the tables.
std::size_t LargestJpegBytes(const hal::FrameFormat& format) {
    const auto width = static_cast<std::size_t>(RoundUp(format.width_px, 16));
    const auto height = static_cast<std::size_t>(RoundUp(format.height_px, 16));
    return width * height * 3 + 2048;
}

const hal::FrameFormat& Expected(const hal::FrameFormat& format) {
    const auto is_side = [](int px) { return px >= 2 && px <= kLongestSide_px && px % 2 == 0; };
    HV_EXPECT(is_side(format.width_px) && is_side(format.height_px));
    HV_EXPECT(format.pixel_format == hal::PixelFormat::kI420 && format.range == hal::Range::kFull);
    return format;
}

[[noreturn]] void StopOnError(j_common_ptr compressor) {
    (*compressor->err->output_message)(compressor);
    std::abort();
}

}  // namespace

JpegEncoder::Compressor::Compressor(const hal::FrameFormat& format) : jpeg_compress_struct{} {
    err = jpeg_std_error(&errors);
    errors.error_exit = StopOnError;
    jpeg_create_compress(this);
    image_width = static_cast<JDIMENSION>(format.width_px);
    image_height = static_cast<JDIMENSION>(format.height_px);
    input_components = 3;
    in_color_space = JCS_YCbCr;
    jpeg_set_defaults(this);  // 4:2:0, baseline
    raw_data_in = TRUE;
    dct_method = JDCT_ISLOW;
    dest = &destination;
    destination.init_destination = [](j_compress_ptr) {};
    destination.empty_output_buffer = [](j_compress_ptr) -> boolean { std::abort(); };
    destination.term_destination = [](j_compress_ptr) {};
}

JpegEncoder::Band::Band(int width, int padded_width, int row_count)
    : width_px(width),
      stride_bytes(padded_width),
      rows(row_count),
      pixels(static_cast<std::size_t>(padded_width) * static_cast<std::size_t>(row_count)) {
    for (int row = 0; row < rows; ++row) row_starts.at(row) = pixels.data() + row * stride_bytes;
}

void JpegEncoder::Band::Fill(const hal::Plane& plane, int first_row, int plane_rows) {
    for (int row = 0; row < rows; ++row) {
        const int source_row = std::min(first_row + row, plane_rows - 1);
        const std::uint8_t* const source =
            plane.data + static_cast<std::ptrdiff_t>(source_row) * plane.stride_bytes;
        std::uint8_t* const target = row_starts.at(row);
        std::memcpy(target, source, static_cast<std::size_t>(width_px));
        std::memset(target + width_px, source[width_px - 1],
                    static_cast<std::size_t>(stride_bytes - width_px));
    }
}

JpegEncoder::JpegEncoder(const hal::FrameFormat& format, const JpegQualityGovernorOptions& options)
    : format_(Expected(format)),
      governor_(options),
      output_(LargestJpegBytes(format)),
      bands_{Band(format.width_px, RoundUp(format.width_px, 16), kMcuRows),
             Band(format.width_px / 2, RoundUp(format.width_px, 16) / 2, kMcuRows / 2),
             Band(format.width_px / 2, RoundUp(format.width_px, 16) / 2, kMcuRows / 2)},
      compressor_(format),
      memory_(compressor_) {}

hal::Result<std::span<const std::uint8_t>> JpegEncoder::Encode(const hal::FrameView& frame) {
    HV_EXPECT(frame.format == format_);
    const int quality = governor_.quality();
    std::span<const std::uint8_t> jpeg = Compress(frame, quality);
    governor_.Note(jpeg.size());
    if (governor_.quality() < quality) jpeg = Compress(frame, governor_.quality());
    if (!governor_.IsWithinBudget(jpeg.size())) jpeg = Compress(frame, kLastResortQuality);
    if (!governor_.IsWithinBudget(jpeg.size())) return hal::Error::kTooLarge;
    return jpeg;
}

std::span<const std::uint8_t> JpegEncoder::Compress(const hal::FrameView& frame, int quality) {
    compressor_.destination.next_output_byte = output_.data();
    compressor_.destination.free_in_buffer = output_.size();
    jpeg_set_quality(&compressor_, quality, TRUE);
    jpeg_start_compress(&compressor_, TRUE);
    WriteBands(frame);
    jpeg_finish_compress(&compressor_);
    return std::span(output_).first(output_.size() - compressor_.destination.free_in_buffer);
}

void JpegEncoder::WriteBands(const hal::FrameView& frame) {
    std::array<JSAMPARRAY, 3> rows{bands_[0].row_starts.data(), bands_[1].row_starts.data(),
                                   bands_[2].row_starts.data()};
    for (int y = 0; y < format_.height_px; y += kMcuRows) {
        bands_[0].Fill(frame.planes[0], y, format_.height_px);
        bands_[1].Fill(frame.planes[1], y / 2, format_.height_px / 2);
        bands_[2].Fill(frame.planes[2], y / 2, format_.height_px / 2);
        jpeg_write_raw_data(&compressor_, rows.data(), kMcuRows);
    }
}

}  // namespace hitchview::app
