#include "drivers/lcm_log_picture.hpp"

#include <cstring>

#include "drivers/frame_jpeg_decoder.hpp"
#include "lcmtypes/bot_core_image_t.h"

namespace hitchview::drivers {
namespace {

using hal::PixelFormat;

std::optional<PixelFormat> FormatOf(std::int32_t fourcc) {
    switch (fourcc) {
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG:
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12:
            return PixelFormat::kNv12;
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY:
            return PixelFormat::kUyvy;
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_YUYV:
            return PixelFormat::kYuyv;
        case BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY:
            return PixelFormat::kGrey;
        default:
            return std::nullopt;
    }
}

bool IsSide(int side_px) {
    return side_px >= 16 && side_px <= 8192 && side_px % 2 == 0;
}

/// The lines of all planes, one below the other: they have the same length in each layout.
struct Lines {
    std::size_t count;
    std::size_t bytes;
};

Lines LinesOf(const hal::FrameFormat& format) {
    const auto width = static_cast<std::size_t>(format.width_px);
    const auto height = static_cast<std::size_t>(format.height_px);
    switch (format.pixel_format) {
        case PixelFormat::kUyvy:
        case PixelFormat::kYuyv:
            return {height, 2 * width};
        case PixelFormat::kNv12:
            return {height * 3 / 2, width};
        default:
            return {height, width};
    }
}

hal::Result<hal::Done> CopyLines(const LoggedImage& image, const Lines& lines,
                                 std::span<std::uint8_t> frame) {
    const auto given = static_cast<std::size_t>(image.row_stride_bytes);
    const std::size_t stride = given > 0 ? given : lines.bytes;
    if (stride < lines.bytes || image.data.size() < stride * (lines.count - 1) + lines.bytes)
        return hal::Error::kCorrupted;
    for (std::size_t i = 0; i < lines.count; ++i)
        std::memcpy(frame.data() + i * lines.bytes, image.data.data() + i * stride, lines.bytes);
    return hal::Done{};
}

}  // namespace

std::optional<LcmLogPictureKind> PictureKindOf(const LoggedImage& image) {
    const auto format = FormatOf(image.fourcc);
    if (!format || !IsSide(image.width_px) || !IsSide(image.height_px)) return std::nullopt;
    const bool compressed = image.fourcc == BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG;
    return LcmLogPictureKind{.format = {.width_px = image.width_px,
                                        .height_px = image.height_px,
                                        .pixel_format = *format,
                                        .range = compressed ? hal::Range::kFull : image.range},
                             .compressed = compressed};
}

LcmLogPictureDecoder::LcmLogPictureDecoder(const LcmLogPictureKind& kind) : kind_(kind) {
    if (kind.compressed) jpeg_ = std::make_unique<FrameJpegDecoder>(kind.format);
}

LcmLogPictureDecoder::~LcmLogPictureDecoder() = default;

hal::Result<hal::Done> LcmLogPictureDecoder::Decode(const LoggedImage& image,
                                                    std::span<std::uint8_t> frame) {
    HV_EXPECT(frame.size() == hal::FrameBytes(kind_.format));
    if (PictureKindOf(image) != kind_) return hal::Error::kCorrupted;
    if (jpeg_) return jpeg_->Decode(image.data, frame);
    return CopyLines(image, LinesOf(kind_.format), frame);
}

}  // namespace hitchview::drivers
