#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "app/jpeg_memory.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// Compresses a band of rows of I420 frames to a JPEG of its own, so that several threads can share
/// one picture: JPEG starts anew after each restart marker, so the bands' scans with such markers
/// between them are the scan of the whole picture (ITU-T T.81, E.1.4). All memory is taken at
/// construction. Thread: one at a time.
class JpegSlice {
 public:
    /// Luma rows of a row of blocks: what libjpeg takes at once. Slices start at multiples of it.
    static constexpr int kBlockRows = 16;

    /// Rows [first_row, first_row + rows) of frames of this format, which is I420.
    /// `restart_interval`: what the JPEG's header says of it, in blocks of 16 x 16; at least those
    /// of this slice, at most 65535; 0: none.
    JpegSlice(const hal::FrameFormat& format, int first_row, int rows, int restart_interval);

    /// No JPEG of this slice has more bytes.
    [[nodiscard]] std::size_t LargestBytes() const;

    /// Writes the JPEG of these rows to `output`, which has LargestBytes. Returns what it filled.
    std::span<std::uint8_t> Compress(const hal::FrameView& frame, int quality,
                                     std::span<std::uint8_t> output);

 private:
    /// The compressor with its settings, before JpegMemory takes over.
    struct Compressor : jpeg_compress_struct {
        Compressor(int width_px, int height_px, int interval);
        ~Compressor() { jpeg_destroy_compress(this); }
        Compressor(const Compressor&) = delete;
        Compressor& operator=(const Compressor&) = delete;

        jpeg_error_mgr errors{};
        jpeg_destination_mgr destination{};
    };

    /// Rows of one plane, widened to whole blocks.
    struct Band {
        int width_px = 0;
        int stride_bytes = 0;
        int rows = 0;
        std::vector<std::uint8_t> pixels;
        std::array<JSAMPROW, kBlockRows> row_starts{};

        Band(int width, int padded_width, int row_count);
        void Fill(const hal::Plane& plane, int first_row, int end_row);
    };

    int width_px_;
    int first_row_;
    int end_row_;
    std::array<Band, 3> bands_;
    Compressor compressor_;
    JpegMemory memory_;
};

}  // namespace hitchview::app
