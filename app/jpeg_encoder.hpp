#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "app/jpeg_memory.hpp"
#include "app/jpeg_quality_governor.hpp"
#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::app {

/// Compresses I420 frames of one size to JPEG within a byte budget. All memory is taken at
/// construction. Thread: the publisher's.
///
/// A picture beyond the budget is compressed once more at the lower quality that the governor
/// gives, and if that is not enough (noise from edge to edge) a last time at kLastResortQuality:
/// display units with the kernel's own receive buffer would not get a larger message at all.
class JpegEncoder {
 public:
    static constexpr int kLastResortQuality = 3;

    /// `format`: I420, full range, even sides in [2, 16384].
    JpegEncoder(const hal::FrameFormat& format, const JpegQualityGovernorOptions& options);

    /// The frame must have the format given at construction. The bytes are valid until the next
    /// call. kTooLarge: beyond the budget even at the last resort.
    hal::Result<std::span<const std::uint8_t>> Encode(const hal::FrameView& frame);

    /// Of the next picture.
    [[nodiscard]] int quality() const { return governor_.quality(); }

 private:
    /// The compressor with its settings, before JpegMemory takes over.
    struct Compressor : jpeg_compress_struct {
        explicit Compressor(const hal::FrameFormat& format);
        ~Compressor() { jpeg_destroy_compress(this); }
        Compressor(const Compressor&) = delete;
        Compressor& operator=(const Compressor&) = delete;

        jpeg_error_mgr errors{};
        jpeg_destination_mgr destination{};
    };
    static constexpr int kMcuRows = 16;  ///< luma rows that libjpeg takes at once

    /// Rows of one plane, widened to whole blocks.
    struct Band {
        int width_px = 0;
        int stride_bytes = 0;
        int rows = 0;
        std::vector<std::uint8_t> pixels;
        std::array<JSAMPROW, kMcuRows> row_starts{};

        Band(int width, int padded_width, int row_count);
        void Fill(const hal::Plane& plane, int first_row, int plane_rows);
    };

    std::span<const std::uint8_t> Compress(const hal::FrameView& frame, int quality);
    void WriteBands(const hal::FrameView& frame);

    hal::FrameFormat format_;
    JpegQualityGovernor governor_;
    std::vector<std::uint8_t> output_;
    std::array<Band, 3> bands_;
    Compressor compressor_;
    JpegMemory memory_;
};

}  // namespace hitchview::app
