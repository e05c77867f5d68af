#include "app/preview_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/expect.hpp"

namespace hitchview::app {
namespace {

/// One component of a frame: where its samples stand.
struct Samples {
    const std::uint8_t* data = nullptr;  ///< null: the frame has no such component
    int stride_bytes = 0;
    int step_bytes = 1;
    int width = 0;
    int height = 0;
};

struct Components {
    Samples y, u, v;
};

Samples LumaOf(const hal::FrameView& frame, int first_byte, int step_bytes) {
    return {frame.planes[0].data + first_byte, frame.planes[0].stride_bytes, step_bytes,
            frame.format.width_px, frame.format.height_px};
}

Components Packed(const hal::FrameView& frame, int y_at, int u_at, int v_at) {
    const hal::Plane& plane = frame.planes[0];
    const int half = frame.format.width_px / 2;
    const int height = frame.format.height_px;
    return {LumaOf(frame, y_at, 2),
            {plane.data + u_at, plane.stride_bytes, 4, half, height},
            {plane.data + v_at, plane.stride_bytes, 4, half, height}};
}

Components Planar(const hal::FrameView& frame, const std::uint8_t* u, const std::uint8_t* v,
                  int step_bytes) {
    const int stride = frame.planes[1].stride_bytes;
    const int width = frame.format.width_px / 2;
    const int height = frame.format.height_px / 2;
    return {LumaOf(frame, 0, 1),
            {u, stride, step_bytes, width, height},
            {v, stride, step_bytes, width, height}};
}

Components ComponentsOf(const hal::FrameView& frame) {
    switch (frame.format.pixel_format) {
        case hal::PixelFormat::kNv12:
            return Planar(frame, frame.planes[1].data, frame.planes[1].data + 1, 2);
        case hal::PixelFormat::kI420:
            return Planar(frame, frame.planes[1].data, frame.planes[2].data, 1);
        case hal::PixelFormat::kUyvy:
            return Packed(frame, 1, 0, 2);
        case hal::PixelFormat::kYuyv:
            return Packed(frame, 0, 1, 3);
        case hal::PixelFormat::kGrey:
            break;
    }
    return {LumaOf(frame, 0, 1), {}, {}};
}

int MeanOf(const Samples& in, int left, int top, int right, int bottom) {
    int sum = 0;
    for (int y = top; y < bottom; ++y) {
        const std::uint8_t* const row = in.data + static_cast<std::ptrdiff_t>(y) * in.stride_bytes;
        for (int x = left; x < right; ++x) sum += row[x * in.step_bytes];
    }
    const int count = (right - left) * (bottom - top);
    return (sum + count / 2) / count;
}

/// What a sample of television's range is in a JPEG.
struct Scale {
    int from = 0;  ///< the value that stays `to`
    int to = 0;
    double gain = 1;

    [[nodiscard]] std::uint8_t operator()(int value) const {
        const double full = to + gain * (value - from);
        return static_cast<std::uint8_t>(std::clamp<long>(std::lround(full), 0, 255));
    }
};

/// First and end of part `i` of `parts` of a length; not empty even where there are more parts.
std::pair<int, int> Part(int length, int i, int parts) {
    const int first = i * length / parts;
    return {first, std::max(first + 1, (i + 1) * length / parts)};
}

void Reduce(const Samples& in, const Scale& scale, int width, int height, std::uint8_t* out) {
    if (in.data == nullptr) {
        std::fill_n(out, width * height, std::uint8_t{128});
        return;
    }
    for (int y = 0; y < height; ++y) {
        const auto [top, bottom] = Part(in.height, y, height);
        for (int x = 0; x < width; ++x) {
            const auto [left, right] = Part(in.width, x, width);
            *out++ = scale(MeanOf(in, left, top, right, bottom));
        }
    }
}

}  // namespace

void ReduceToPreview(const hal::FrameView& frame, std::span<std::uint8_t> preview) {
    HV_EXPECT(preview.size() == hal::FrameBytes(kPreviewFormat));
    const bool full = frame.format.range == hal::Range::kFull;
    const Scale luma = full ? Scale{} : Scale{16, 0, 255.0 / 219};
    const Scale chroma = full ? Scale{} : Scale{128, 128, 255.0 / 224};
    constexpr int kLuma = kPreviewWidth_px * kPreviewHeight_px;
    const Components in = ComponentsOf(frame);
    Reduce(in.y, luma, kPreviewWidth_px, kPreviewHeight_px, preview.data());
    Reduce(in.u, chroma, kPreviewWidth_px / 2, kPreviewHeight_px / 2, preview.data() + kLuma);
    Reduce(in.v, chroma, kPreviewWidth_px / 2, kPreviewHeight_px / 2,
           preview.data() + kLuma + kLuma / 4);
}

}  // namespace hitchview::app
