#pragma once

#include <cstddef>
#include <cstdio>
#include <vector>

// libjpeg's header needs FILE to be declared before it.
#include <jpeglib.h>

namespace hitchview::drivers {

/// Memory of one JPEG decompressor, taken at construction: stands in for libjpeg's malloc from then
/// on. One stack for what lives as long as the decompressor (tables), one for what lives as long as
/// a picture. A picture that asks for more than a baseline one needs is refused by the
/// decompressor's error_exit.
class FrameJpegMemory : private jpeg_memory_mgr {
 public:
    /// `decompressor` must outlive this memory, and gets its own memory back at the end.
    explicit FrameJpegMemory(jpeg_decompress_struct& decompressor);
    ~FrameJpegMemory();

    FrameJpegMemory(const FrameJpegMemory&) = delete;
    FrameJpegMemory& operator=(const FrameJpegMemory&) = delete;

    /// Before each picture: what it does not bring along, tables above all, it does not get from
    /// the picture before it.
    void Forget();

 private:
    /// Blocks one above the other, given back all at once.
    struct Stack {
        std::vector<std::byte> bytes;
        std::size_t used = 0;

        /// Null if it does not fit.
        void* Take(std::size_t count);
    };

    static FrameJpegMemory& Of(j_common_ptr decompressor);
    static void* Take(j_common_ptr decompressor, int pool, std::size_t bytes);
    void ServeBlocks();
    void RefuseArrays();

    jpeg_decompress_struct& decompressor_;
    jpeg_memory_mgr* original_;
    Stack lasting_;
    Stack picture_;
};

}  // namespace hitchview::drivers
