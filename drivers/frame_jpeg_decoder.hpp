#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hal/frame.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// Pictures of a Motion JPEG camera to NV12: baseline, grey or Y'CbCr with 4:2:0, 4:2:2, 4:4:0 or
/// 4:4:4 chroma, which is averaged down; without Huffman tables, as many cameras send them, the
/// standard ones serve. Memory is taken at construction only. Thread: one at a time.
class FrameJpegDecoder {
 public:
    /// `format`: kNv12; every picture has its size.
    explicit FrameJpegDecoder(const hal::FrameFormat& format);
    ~FrameJpegDecoder();
    FrameJpegDecoder(const FrameJpegDecoder&) = delete;
    FrameJpegDecoder& operator=(const FrameJpegDecoder&) = delete;

    /// `nv12`: FrameBytes(format). kCorrupted: cut short, damaged, of another size or kind; `nv12`
    /// then holds part of a picture.
    hal::Result<hal::Done> Decode(std::span<const std::uint8_t> jpeg, std::span<std::uint8_t> nv12);

 private:
    struct Library;

    std::unique_ptr<Library> library_;
};

}  // namespace hitchview::drivers
