#include "app/packed_frame.hpp"

#include <cstring>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

void CopyRows(const hal::Plane& plane, int rows, std::size_t row_bytes, std::uint8_t*& to) {
    for (int row = 0; row < rows; ++row, to += row_bytes)
        std::memcpy(to, plane.data + static_cast<std::ptrdiff_t>(row) * plane.stride_bytes,
                    row_bytes);
}

}  // namespace

std::span<std::uint8_t> PackFrame(const hal::FrameView& frame, std::span<std::uint8_t> to) {
    HV_EXPECT(to.size() >= hal::FrameBytes(frame.format));
    const auto& [width_px, height_px, pixel_format, range] = frame.format;
    const auto width = static_cast<std::size_t>(width_px);
    const bool pairs =
        pixel_format == hal::PixelFormat::kUyvy || pixel_format == hal::PixelFormat::kYuyv;
    std::uint8_t* end = to.data();
    CopyRows(frame.planes[0], height_px, pairs ? 2 * width : width, end);
    if (pixel_format == hal::PixelFormat::kNv12)
        CopyRows(frame.planes[1], height_px / 2, width, end);
    if (pixel_format == hal::PixelFormat::kI420) {
        CopyRows(frame.planes[1], height_px / 2, width / 2, end);
        CopyRows(frame.planes[2], height_px / 2, width / 2, end);
    }
    return {to.data(), end};
}

}  // namespace hitchview::app
