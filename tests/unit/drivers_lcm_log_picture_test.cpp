#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <vector>

#include "drivers/lcm_log_picture.hpp"
#include "lcmtypes/bot_core_image_t.h"
#include "tests/support/jpeg_picture.hpp"

namespace hitchview::drivers {
namespace {

constexpr int kWidth = 32;
constexpr int kHeight = 16;

LoggedImage Image(std::int32_t fourcc, std::span<const std::uint8_t> data, int stride = 0) {
    return {.width_px = kWidth,
            .height_px = kHeight,
            .row_stride_bytes = stride,
            .fourcc = fourcc,
            .data = data,
            .range = hal::Range::kLimited};
}

std::vector<std::uint8_t> Counting(std::size_t count) {
    std::vector<std::uint8_t> bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
    return bytes;
}

struct RawCase {
    std::int32_t fourcc;
    hal::PixelFormat format;
    std::size_t line_bytes;
    std::size_t lines;
};

class RawPictureTest : public testing::TestWithParam<RawCase> {};

TEST_P(RawPictureTest, StaysAsItIsWhateverLiesBetweenItsLines) {
    const RawCase& raw = GetParam();
    const std::size_t stride = raw.line_bytes + 12;
    const auto data = Counting(stride * raw.lines);
    const LoggedImage image = Image(raw.fourcc, data, static_cast<int>(stride));
    const auto kind = PictureKindOf(image);
    ASSERT_TRUE(kind.has_value());
    EXPECT_FALSE(kind->compressed);
    EXPECT_EQ(kind->format, (hal::FrameFormat{kWidth, kHeight, raw.format, hal::Range::kLimited}));
    LcmLogPictureDecoder decoder(*kind);
    std::vector<std::uint8_t> frame(hal::FrameBytes(kind->format));
    ASSERT_TRUE(decoder.Decode(image, frame).ok());
    for (std::size_t i = 0; i < frame.size(); ++i)
        ASSERT_EQ(frame[i], data[i / raw.line_bytes * stride + i % raw.line_bytes]);

    // The last line may end the message; one byte less is damage.
    const std::size_t needed = stride * (raw.lines - 1) + raw.line_bytes;
    const std::span whole(data);
    EXPECT_TRUE(
        decoder.Decode(Image(raw.fourcc, whole.first(needed), static_cast<int>(stride)), frame)
            .ok());
    EXPECT_FALSE(
        decoder.Decode(Image(raw.fourcc, whole.first(needed - 1), static_cast<int>(stride)), frame)
            .ok());
    EXPECT_FALSE(
        decoder.Decode(Image(raw.fourcc, whole, static_cast<int>(raw.line_bytes - 1)), frame).ok());
}

INSTANTIATE_TEST_SUITE_P(Formats, RawPictureTest,
                         testing::Values(RawCase{BOT_CORE_IMAGE_T_PIXEL_FORMAT_UYVY,
                                                 hal::PixelFormat::kUyvy, 2 * kWidth, kHeight},
                                         RawCase{BOT_CORE_IMAGE_T_PIXEL_FORMAT_YUYV,
                                                 hal::PixelFormat::kYuyv, 2 * kWidth, kHeight},
                                         RawCase{BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12,
                                                 hal::PixelFormat::kNv12, kWidth, kHeight * 3 / 2},
                                         RawCase{BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY,
                                                 hal::PixelFormat::kGrey, kWidth, kHeight}));

TEST(LcmLogPictureTest, AJpegBecomesNv12) {
    const auto jpeg = tests::JpegPicture(kWidth, kHeight, TJSAMP_420, 1);
    const LoggedImage image = Image(BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG, jpeg);
    const auto kind = PictureKindOf(image);
    ASSERT_TRUE(kind.has_value());
    EXPECT_EQ(kind->format,
              (hal::FrameFormat{kWidth, kHeight, hal::PixelFormat::kNv12, hal::Range::kFull}));
    LcmLogPictureDecoder decoder(*kind);
    std::vector<std::uint8_t> frame(hal::FrameBytes(kind->format));
    ASSERT_TRUE(decoder.Decode(image, frame).ok());
    const auto reference = tests::ReferencePlanes(jpeg);
    for (std::size_t i = 0; i < reference.samples[0].size(); ++i)
        ASSERT_EQ(frame[i], reference.samples[0][i]);
    const std::span cut = std::span(jpeg).first(jpeg.size() / 2);
    EXPECT_FALSE(decoder.Decode(Image(BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG, cut), frame).ok());
}

TEST(LcmLogPictureTest, OtherPixelsAndSizesAreRefused) {
    const auto data = Counting(64 * 64 * 3);
    EXPECT_FALSE(PictureKindOf(Image(BOT_CORE_IMAGE_T_PIXEL_FORMAT_RGB, data)).has_value());
    LoggedImage odd = Image(BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY, data);
    odd.width_px = 33;
    EXPECT_FALSE(PictureKindOf(odd).has_value());

    LcmLogPictureDecoder decoder(*PictureKindOf(Image(BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY, data)));
    std::vector<std::uint8_t> frame(static_cast<std::size_t>(kWidth * kHeight));
    LoggedImage larger = Image(BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY, data);
    larger.width_px = 64;
    EXPECT_FALSE(decoder.Decode(larger, frame).ok());
    EXPECT_FALSE(decoder.Decode(Image(BOT_CORE_IMAGE_T_PIXEL_FORMAT_NV12, data), frame).ok());
}

}  // namespace
}  // namespace hitchview::drivers
