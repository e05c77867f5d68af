#include "drivers/frame_colour.hpp"

#include <algorithm>

namespace hitchview::drivers {
namespace {

// BT.601 in 1/65536; each row of weights sums to 65536 (luma) or 0 (chroma).
constexpr int kHalf = 1 << 15;
constexpr int kLumaB = 7471;
constexpr int kLumaG = 38470;
constexpr int kLumaR = 19595;
constexpr int kCbG = -21709;
constexpr int kCbR = -11059;
constexpr int kCrB = -5329;
constexpr int kCrG = -27439;

// kBlue: which byte of a pixel is blue; the other end is red.
template <int kBlue>
void LumaRow(const std::uint8_t* bgr, int width_px, std::uint8_t* luma) {
    for (int x = 0; x < width_px; ++x, bgr += 3) {
        luma[x] = static_cast<std::uint8_t>(
            (kLumaB * bgr[kBlue] + kLumaG * bgr[1] + kLumaR * bgr[2 - kBlue] + kHalf) >> 16);
    }
}

// `sum`: weighted sum over four pixels.
std::uint8_t Chroma(int sum) {
    return static_cast<std::uint8_t>(std::clamp((sum + (128 << 18) + (1 << 17)) >> 18, 0, 255));
}

template <int kBlue>
void ChromaRow(const std::uint8_t* upper, const std::uint8_t* lower, int width_px,
               std::uint8_t* chroma) {
    constexpr int kRed = 2 - kBlue;
    for (int x = 0; x < width_px; x += 2, upper += 6, lower += 6) {
        const int b = upper[kBlue] + upper[kBlue + 3] + lower[kBlue] + lower[kBlue + 3];
        const int g = upper[1] + upper[4] + lower[1] + lower[4];
        const int r = upper[kRed] + upper[kRed + 3] + lower[kRed] + lower[kRed + 3];
        chroma[x] = Chroma(kHalf * b + kCbG * g + kCbR * r);
        chroma[x + 1] = Chroma(kCrB * b + kCrG * g + kHalf * r);
    }
}

// Mean over the 2 x 2 pixels whose top left one is (x, y).
std::uint8_t MeanChroma(const YuvPicture& picture, int plane, int x, int y) {
    const auto& [data, stride_bytes] = picture.planes[static_cast<std::size_t>(plane)];
    const std::uint8_t* upper = data + (y >> picture.chroma_shift_y) * std::ptrdiff_t{stride_bytes};
    const std::uint8_t* lower =
        data + ((y + 1) >> picture.chroma_shift_y) * std::ptrdiff_t{stride_bytes};
    const int left = x >> picture.chroma_shift_x;
    const int right = (x + 1) >> picture.chroma_shift_x;
    return static_cast<std::uint8_t>(
        (upper[left] + upper[right] + lower[left] + lower[right] + 2) >> 2);
}

void ChromaRow(const YuvPicture& picture, int y, int width_px, std::uint8_t* chroma) {
    for (int x = 0; x < width_px; x += 2) {
        chroma[x] = MeanChroma(picture, 1, x, y);
        chroma[x + 1] = MeanChroma(picture, 2, x, y);
    }
}

template <int kBlue>
void PackedToNv12(const BgrPicture& picture, const hal::FrameFormat& format,
                  std::span<std::uint8_t> nv12) {
    const int width_px = format.width_px;
    std::uint8_t* luma = nv12.data();
    std::uint8_t* chroma = luma + std::ptrdiff_t{width_px} * format.height_px;
    for (int y = 0; y < format.height_px; y += 2) {
        const std::uint8_t* upper = picture.data + y * picture.stride_bytes;
        const std::uint8_t* lower = upper + picture.stride_bytes;
        LumaRow<kBlue>(upper, width_px, luma + std::ptrdiff_t{y} * width_px);
        LumaRow<kBlue>(lower, width_px, luma + std::ptrdiff_t{y + 1} * width_px);
        ChromaRow<kBlue>(upper, lower, width_px, chroma + std::ptrdiff_t{y / 2} * width_px);
    }
}

}  // namespace

void ToNv12(const BgrPicture& picture, const hal::FrameFormat& format,
            std::span<std::uint8_t> nv12) {
    if (picture.order == ChannelOrder::kBlueGreenRed) {
        PackedToNv12<0>(picture, format, nv12);
    } else {
        PackedToNv12<2>(picture, format, nv12);
    }
}

void ToNv12(const YuvPicture& picture, const hal::FrameFormat& format,
            std::span<std::uint8_t> nv12) {
    const int width_px = format.width_px;
    std::uint8_t* row = nv12.data();
    for (int y = 0; y < format.height_px; ++y, row += width_px) {
        const hal::Plane& luma = picture.planes[0];
        std::copy_n(luma.data + y * std::ptrdiff_t{luma.stride_bytes}, width_px, row);
    }
    const bool grey = picture.planes[1].data == nullptr;
    for (int y = 0; y < format.height_px; y += 2, row += width_px) {
        if (grey) {
            std::fill_n(row, width_px, std::uint8_t{128});
        } else {
            ChromaRow(picture, y, width_px, row);
        }
    }
}

}  // namespace hitchview::drivers
