#include "app/jpeg_join.hpp"

#include <algorithm>
#include <cstddef>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

// Markers of ITU-T T.81, table B.1; each follows a byte of ones.
constexpr std::uint8_t kBaselineFrame = 0xC0;
constexpr std::uint8_t kRestart = 0xD0;  // the first of eight, which take turns
constexpr std::size_t kRestartMarkers = 8;
constexpr std::uint8_t kScan = 0xDA;
constexpr std::size_t kMarkerBytes = 2;

/// Where the segment with this marker begins.
std::size_t FindSegment(std::span<const std::uint8_t> jpeg, std::uint8_t marker) {
    std::size_t at = kMarkerBytes;  // after the start of the image
    while (jpeg[at + 1] != marker) {
        at += kMarkerBytes + static_cast<std::size_t>(jpeg[at + 2]) * 256 + jpeg[at + 3];
        HV_EXPECT(at + 3 < jpeg.size());
    }
    return at;
}

/// What lies between the scan's header and the end of the image.
std::span<const std::uint8_t> ScanOf(std::span<const std::uint8_t> jpeg) {
    const std::size_t header = FindSegment(jpeg, kScan);
    const std::size_t scan =
        header + kMarkerBytes + static_cast<std::size_t>(jpeg[header + 2]) * 256 + jpeg[header + 3];
    return jpeg.subspan(scan, jpeg.size() - scan - kMarkerBytes);
}

void WriteHeight(std::span<std::uint8_t> jpeg, int height_px) {
    constexpr std::size_t kHeight = 5;  // after marker, length and precision
    const std::size_t frame = FindSegment(jpeg, kBaselineFrame);
    jpeg[frame + kHeight] = static_cast<std::uint8_t>(height_px / 256);
    jpeg[frame + kHeight + 1] = static_cast<std::uint8_t>(height_px % 256);
}

}  // namespace

std::span<std::uint8_t> JoinJpegBands(std::span<std::uint8_t> memory,
                                      std::span<const std::span<std::uint8_t>> bands,
                                      int height_px) {
    HV_EXPECT(!bands.empty() && bands.front().data() == memory.data());
    WriteHeight(bands.front(), height_px);
    if (bands.size() == 1) return bands.front();
    auto end = memory.begin() + static_cast<std::ptrdiff_t>(bands.front().size() - kMarkerBytes);
    for (std::size_t i = 1; i < bands.size(); ++i) {
        const auto scan = ScanOf(bands[i]);  // its header leaves room for the marker
        *end++ = 0xFF;
        *end++ = static_cast<std::uint8_t>(kRestart + (i - 1) % kRestartMarkers);
        end = std::copy(scan.begin(), scan.end(), end);
    }
    *end++ = 0xFF;
    *end++ = 0xD9;  // end of image
    return memory.first(static_cast<std::size_t>(end - memory.begin()));
}

}  // namespace hitchview::app
