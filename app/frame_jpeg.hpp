#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "app/jpeg_memory.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// Compresses cameras' frames to JPEG as they are: 4:2:2 stays 4:2:2 (UYVY, YUYV), 4:2:0 stays
/// 4:2:0 (NV12, I420), grey stays grey, and values of a limited range stay limited. All memory is
/// taken at construction. Thread: one at a time.
class FrameJpeg {
 public:
    /// `quality`: [1, 100].
    FrameJpeg(const hal::FrameFormat& format, int quality);

    [[nodiscard]] const hal::FrameFormat& format() const { return format_; }
    /// The frame has this format. Valid until the next call.
    std::span<const std::uint8_t> Compress(const hal::FrameView& frame);

 private:
    static constexpr int kMostRows = 16;  ///< of luma that libjpeg takes at once

    struct Compressor : jpeg_compress_struct {
        Compressor(const hal::FrameFormat& format, int quality);
        ~Compressor() { jpeg_destroy_compress(this); }
        Compressor(const Compressor&) = delete;
        Compressor& operator=(const Compressor&) = delete;

        jpeg_error_mgr errors{};
        jpeg_destination_mgr destination{};
    };

    /// A few rows of one component, widened to whole blocks.
    struct Rows {
        int width_px = 0;
        int stride_bytes = 0;
        std::vector<std::uint8_t> pixels{};
        std::array<JSAMPROW, kMostRows> starts{};

        void TakeMemory(int width, int padded_width, int rows);
        [[nodiscard]] std::uint8_t* row(int i) const {
            return starts.at(static_cast<std::size_t>(i));
        }
        void Widen(int i) const;
    };

    void FillPacked(const hal::FrameView& frame, int first_row);
    void FillPlanes(const hal::FrameView& frame, int first_row);

    hal::FrameFormat format_;
    int luma_rows_;  ///< at once
    std::array<Rows, 3> rows_;
    std::vector<std::uint8_t> output_;
    Compressor compressor_;
    JpegMemory memory_;
};

}  // namespace hitchview::app
