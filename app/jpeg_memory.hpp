#pragma once

#include <cstddef>
#include <cstdio>
#include <vector>

// libjpeg's header needs FILE to be declared before it.
#include <jpeglib.h>

namespace hitchview::app {

/// Memory of one JPEG compressor, taken at construction. libjpeg asks for the same few blocks with
/// each picture and gives them all back at its end, so a bump allocator serves it; installed once
/// the compressor is set up, it stands in for libjpeg's malloc from then on. Serves baseline
/// compression of raw planes; any other request is our bug.
class JpegMemory : private jpeg_memory_mgr {
 public:
    /// `compressor` must outlive this memory, and gets its own memory back at the end.
    explicit JpegMemory(jpeg_compress_struct& compressor);
    ~JpegMemory();
    JpegMemory(const JpegMemory&) = delete;
    JpegMemory& operator=(const JpegMemory&) = delete;

 private:
    static JpegMemory& Of(j_common_ptr compressor);
    static void* Take(j_common_ptr compressor, int pool, std::size_t bytes);
    void ServeBlocks();
    void RefuseArrays();

    jpeg_compress_struct& compressor_;
    jpeg_memory_mgr* original_;
    std::vector<std::byte> memory_;
    std::size_t used_bytes_;
};

}  // namespace hitchview::app
