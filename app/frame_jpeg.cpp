#include "app/frame_jpeg.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "algo/multiversion.hpp"
#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

using hal::PixelFormat;

int RoundUp(int value, int unit) {
    return (value + unit - 1) / unit * unit;
}

[[noreturn]] void StopOnError(j_common_ptr compressor) {
    (*compressor->err->output_message)(compressor);
    std::abort();
}

bool IsPacked422(PixelFormat format) {
    return format == PixelFormat::kUyvy || format == PixelFormat::kYuyv;
}

/// Rows of luma in a row of blocks.
int BlockRows(PixelFormat format) {
    const bool halved = format == PixelFormat::kNv12 || format == PixelFormat::kI420;
    return halved ? 2 * DCTSIZE : DCTSIZE;
}

/// No JPEG of such a frame has more bytes: 27 bits for each value of its whole blocks is what the
/// longest codes take, and there are the tables.
std::size_t LargestBytes(const hal::FrameFormat& format) {
    constexpr std::size_t kTables = 2048;
    const hal::FrameFormat padded{RoundUp(format.width_px, 16), RoundUp(format.height_px, 16),
                                  format.pixel_format, format.range};
    return 4 * hal::FrameBytes(padded) + kTables;
}

/// Two pixels in four bytes to planes; `luma_at`: the byte of the first luma, 0 or 1.
template <int luma_at>
[[gnu::always_inline]] inline void Split422(const std::uint8_t* __restrict from, int pairs,
                                            std::uint8_t* __restrict y, std::uint8_t* __restrict u,
                                            std::uint8_t* __restrict v) {
    for (int i = 0; i < pairs; ++i) {
        y[2 * i] = from[4 * i + luma_at];
        y[2 * i + 1] = from[4 * i + 2 + luma_at];
        u[i] = from[4 * i + 1 - luma_at];
        v[i] = from[4 * i + 3 - luma_at];
    }
}

HV_MULTIVERSION void SplitUyvy(const std::uint8_t* from, int pairs, std::uint8_t* y,
                               std::uint8_t* u, std::uint8_t* v) {
    Split422<1>(from, pairs, y, u, v);
}

HV_MULTIVERSION void SplitYuyv(const std::uint8_t* from, int pairs, std::uint8_t* y,
                               std::uint8_t* u, std::uint8_t* v) {
    Split422<0>(from, pairs, y, u, v);
}

HV_MULTIVERSION void SplitPairs(const std::uint8_t* __restrict from, int pairs,
                                std::uint8_t* __restrict u, std::uint8_t* __restrict v) {
    for (int i = 0; i < pairs; ++i) {
        u[i] = from[2 * i];
        v[i] = from[2 * i + 1];
    }
}

const std::uint8_t* RowOf(const hal::Plane& plane, int row) {
    return plane.data + static_cast<std::ptrdiff_t>(row) * plane.stride_bytes;
}

}  // namespace

FrameJpeg::Compressor::Compressor(const hal::FrameFormat& format, int quality)
    : jpeg_compress_struct{} {
    err = jpeg_std_error(&errors);
    errors.error_exit = StopOnError;
    jpeg_create_compress(this);
    const bool grey = format.pixel_format == PixelFormat::kGrey;
    image_width = static_cast<JDIMENSION>(format.width_px);
    image_height = static_cast<JDIMENSION>(format.height_px);
    input_components = grey ? 1 : 3;
    in_color_space = grey ? JCS_GRAYSCALE : JCS_YCbCr;
    jpeg_set_defaults(this);  // baseline, 4:2:0
    if (IsPacked422(format.pixel_format)) comp_info[0].v_samp_factor = 1;
    jpeg_set_quality(this, quality, TRUE);
    raw_data_in = TRUE;
    dct_method = JDCT_ISLOW;
    dest = &destination;
    destination.init_destination = [](j_compress_ptr) {};
    destination.empty_output_buffer = [](j_compress_ptr) -> boolean { std::abort(); };
    destination.term_destination = [](j_compress_ptr) {};
}

void FrameJpeg::Rows::TakeMemory(int width, int padded_width, int rows) {
    width_px = width;
    stride_bytes = padded_width;
    pixels.resize(static_cast<std::size_t>(padded_width) * static_cast<std::size_t>(rows));
    for (int i = 0; i < rows; ++i)
        starts.at(static_cast<std::size_t>(i)) = pixels.data() + i * stride_bytes;
}

void FrameJpeg::Rows::Widen(int i) const {
    std::uint8_t* const end = row(i) + width_px;
    std::memset(end, end[-1], static_cast<std::size_t>(stride_bytes - width_px));
}

FrameJpeg::FrameJpeg(const hal::FrameFormat& format, int quality)
    : format_(format),
      luma_rows_(BlockRows(format.pixel_format)),
      output_(LargestBytes(format)),
      compressor_(format, quality),
      memory_(compressor_) {
    HV_EXPECT(format.width_px >= 2 && format.width_px % 2 == 0 && format.height_px % 2 == 0);
    const int padded = RoundUp(format.width_px, 16);
    rows_[0].TakeMemory(format.width_px, padded, luma_rows_);
    if (format.pixel_format == PixelFormat::kGrey) return;
    for (Rows* chroma : {&rows_[1], &rows_[2]})
        chroma->TakeMemory(format.width_px / 2, padded / 2, DCTSIZE);
}

std::span<const std::uint8_t> FrameJpeg::Compress(const hal::FrameView& frame) {
    HV_EXPECT(frame.format == format_);
    compressor_.destination.next_output_byte = output_.data();
    compressor_.destination.free_in_buffer = output_.size();
    jpeg_start_compress(&compressor_, TRUE);
    std::array<JSAMPARRAY, 3> rows{rows_[0].starts.data(), rows_[1].starts.data(),
                                   rows_[2].starts.data()};
    for (int y = 0; y < format_.height_px; y += luma_rows_) {
        if (IsPacked422(format_.pixel_format))
            FillPacked(frame, y);
        else
            FillPlanes(frame, y);
        jpeg_write_raw_data(&compressor_, rows.data(), static_cast<JDIMENSION>(luma_rows_));
    }
    jpeg_finish_compress(&compressor_);
    return std::span(output_).first(output_.size() - compressor_.destination.free_in_buffer);
}

/// Below the last row it is repeated.
void FrameJpeg::FillPacked(const hal::FrameView& frame, int first_row) {
    const auto split = format_.pixel_format == PixelFormat::kUyvy ? SplitUyvy : SplitYuyv;
    for (int i = 0; i < luma_rows_; ++i) {
        const int row = std::min(first_row + i, format_.height_px - 1);
        split(RowOf(frame.planes[0], row), format_.width_px / 2, rows_[0].row(i), rows_[1].row(i),
              rows_[2].row(i));
        for (const Rows& component : rows_) component.Widen(i);
    }
}

void FrameJpeg::FillPlanes(const hal::FrameView& frame, int first_row) {
    const auto width = static_cast<std::size_t>(format_.width_px);
    for (int i = 0; i < luma_rows_; ++i) {
        const int row = std::min(first_row + i, format_.height_px - 1);
        std::memcpy(rows_[0].row(i), RowOf(frame.planes[0], row), width);
        rows_[0].Widen(i);
    }
    if (format_.pixel_format == PixelFormat::kGrey) return;
    for (int i = 0; i < DCTSIZE; ++i) {
        const int row = std::min(first_row / 2 + i, format_.height_px / 2 - 1);
        if (format_.pixel_format == PixelFormat::kNv12) {
            SplitPairs(RowOf(frame.planes[1], row), format_.width_px / 2, rows_[1].row(i),
                       rows_[2].row(i));
        } else {
            std::memcpy(rows_[1].row(i), RowOf(frame.planes[1], row), width / 2);
            std::memcpy(rows_[2].row(i), RowOf(frame.planes[2], row), width / 2);
        }
        for (const Rows* chroma : {&rows_[1], &rows_[2]}) chroma->Widen(i);
    }
}

}  // namespace hitchview::app
