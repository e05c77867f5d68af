#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace hitchview::app {

struct AviFormat {
    int width_px = 0;
    int height_px = 0;
    double rate_hz = 30;
    std::uint32_t segment_bytes = 1U
                                  << 30;  ///< picture bytes of one RIFF list; then the next begins
};

/// Motion JPEG in an AVI container with OpenDML indexes (the "OpenDML AVI File Format Extensions",
/// 1996), so that a long recording is not held to one RIFF list's 2 GB. Thread: one.
class AviFile {
 public:
    static hal::Checked<std::unique_ptr<AviFile>> Create(const std::string& path,
                                                         const AviFormat& format);

    /// kTooLarge: 256 segments are full. kFailed: the system refused; errno says why.
    hal::Result<hal::Done> Append(std::span<const std::uint8_t> jpeg);
    /// Writes the indexes and the final header. Nothing may follow.
    hal::Result<hal::Done> Finish();

 private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    struct Picture {
        std::uint32_t offset_bytes;  ///< of the chunk, from the segment's `movi`
        std::uint32_t size_bytes;
    };
    /// Where the index of a finished segment is.
    struct Segment {
        std::uint64_t index_offset_bytes;
        std::uint32_t index_bytes;
        std::uint32_t frames;
    };

    AviFile(std::FILE* file, const AviFormat& format);
    [[nodiscard]] std::vector<std::uint8_t> Header() const;
    [[nodiscard]] std::vector<std::uint8_t> SegmentIndex() const;
    [[nodiscard]] std::vector<std::uint8_t> LegacyIndex() const;
    bool Write(std::span<const std::uint8_t> bytes);
    bool PatchSize(std::uint64_t position, std::uint64_t size_bytes);
    bool BeginSegment();
    bool EndSegment();
    [[nodiscard]] std::uint32_t frames() const;

    std::unique_ptr<std::FILE, Close> file_;
    AviFormat format_;
    std::uint64_t position_ = 0;       ///< bytes written so far
    std::uint64_t movi_ = 0;           ///< position of the open segment's `movi`
    std::vector<Picture> pictures_;    ///< of the open segment
    std::vector<Segment> segments_;    ///< finished
    std::uint32_t largest_bytes_ = 0;  ///< of all pictures
};

}  // namespace hitchview::app
