#include "app/jpeg_slice.hpp"

#include <algorithm>
#include <cstring>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

int RoundUp(int value, int unit) {
    return (value + unit - 1) / unit * unit;
}

[[noreturn]] void StopOnError(j_common_ptr compressor) {
    (*compressor->err->output_message)(compressor);
    std::abort();
}

}  // namespace

JpegSlice::Compressor::Compressor(int width_px, int height_px, int interval)
    : jpeg_compress_struct{} {
    err = jpeg_std_error(&errors);
    errors.error_exit = StopOnError;
    jpeg_create_compress(this);
    image_width = static_cast<JDIMENSION>(width_px);
    image_height = static_cast<JDIMENSION>(height_px);
    input_components = 3;
    in_color_space = JCS_YCbCr;
    jpeg_set_defaults(this);  // 4:2:0, baseline
    restart_interval = static_cast<unsigned>(interval);
    raw_data_in = TRUE;
    dct_method = JDCT_ISLOW;
    dest = &destination;
    destination.init_destination = [](j_compress_ptr) {};
    destination.empty_output_buffer = [](j_compress_ptr) -> boolean { std::abort(); };
    destination.term_destination = [](j_compress_ptr) {};
}

JpegSlice::Band::Band(int width, int padded_width, int row_count)
    : width_px(width),
      stride_bytes(padded_width),
      rows(row_count),
      pixels(static_cast<std::size_t>(padded_width) * static_cast<std::size_t>(row_count)) {
    for (int row = 0; row < rows; ++row) row_starts.at(row) = pixels.data() + row * stride_bytes;
}

void JpegSlice::Band::Fill(const hal::Plane& plane, int first_row, int end_row) {
    for (int row = 0; row < rows; ++row) {
        const int source_row = std::min(first_row + row, end_row - 1);
        const std::uint8_t* const source =
            plane.data + static_cast<std::ptrdiff_t>(source_row) * plane.stride_bytes;
        std::uint8_t* const target = row_starts.at(row);
        std::memcpy(target, source, static_cast<std::size_t>(width_px));
        std::memset(target + width_px, source[width_px - 1],
                    static_cast<std::size_t>(stride_bytes - width_px));
    }
}

JpegSlice::JpegSlice(const hal::FrameFormat& format, int first_row, int rows, int restart_interval)
    : width_px_(format.width_px),
      first_row_(first_row),
      end_row_(first_row + rows),
      bands_{Band(width_px_, RoundUp(width_px_, 16), kBlockRows),
             Band(width_px_ / 2, RoundUp(width_px_, 16) / 2, kBlockRows / 2),
             Band(width_px_ / 2, RoundUp(width_px_, 16) / 2, kBlockRows / 2)},
      compressor_(width_px_, rows, restart_interval),
      memory_(compressor_) {
    HV_EXPECT(rows >= 1 && first_row >= 0 && end_row_ <= format.height_px);
    HV_EXPECT(first_row % kBlockRows == 0 && restart_interval <= 65535);
}

std::size_t JpegSlice::LargestBytes() const {
    // Twice the bytes of its whole blocks, and the tables.
    const auto width = static_cast<std::size_t>(RoundUp(width_px_, 16));
    const auto height = static_cast<std::size_t>(RoundUp(end_row_ - first_row_, kBlockRows));
    return width * height * 3 + 2048;
}

std::span<std::uint8_t> JpegSlice::Compress(const hal::FrameView& frame, int quality,
                                            std::span<std::uint8_t> output) {
    HV_EXPECT(output.size() >= LargestBytes());
    compressor_.destination.next_output_byte = output.data();
    compressor_.destination.free_in_buffer = output.size();
    jpeg_set_quality(&compressor_, quality, TRUE);
    jpeg_start_compress(&compressor_, TRUE);
    std::array<JSAMPARRAY, 3> rows{bands_[0].row_starts.data(), bands_[1].row_starts.data(),
                                   bands_[2].row_starts.data()};
    for (int y = first_row_; y < end_row_; y += kBlockRows) {
        bands_[0].Fill(frame.planes[0], y, end_row_);
        bands_[1].Fill(frame.planes[1], y / 2, end_row_ / 2);
        bands_[2].Fill(frame.planes[2], y / 2, end_row_ / 2);
        jpeg_write_raw_data(&compressor_, rows.data(), kBlockRows);
    }
    jpeg_finish_compress(&compressor_);
    return output.first(output.size() - compressor_.destination.free_in_buffer);
}

}  // namespace hitchview::app
