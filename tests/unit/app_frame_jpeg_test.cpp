#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>
#include <memory>

#include "app/frame_jpeg.hpp"
#include "tests/support/heap_calls.hpp"

namespace hitchview::app {
namespace {

using hal::FrameFormat;
using hal::PixelFormat;
using hal::Range;

/// Smooth waves in every component, another for each.
std::uint8_t Wave(int component, int x, int y) {
    return static_cast<std::uint8_t>(
        std::lround(128 + 70 * std::sin(0.02 * (component + 1) * x + 0.03 * y + component)));
}

/// A frame of such waves with gaps between its rows.
struct WaveFrame {
    FrameFormat format;
    std::vector<std::uint8_t> memory;
    hal::FrameView view;

    explicit WaveFrame(const FrameFormat& of) : format(of) {
        constexpr int kGap = 24;
        const bool pairs =
            of.pixel_format == PixelFormat::kUyvy || of.pixel_format == PixelFormat::kYuyv;
        const int stride = of.width_px * (pairs ? 2 : 1) + kGap;
        memory.resize(static_cast<std::size_t>(stride * of.height_px * 2));
        view.format = of;
        view.planes[0] = {memory.data(), stride};
        view.planes[1] = {memory.data() + stride * of.height_px, stride};
        for (int y = 0; y < of.height_px; ++y)
            for (int x = 0; x < of.width_px; ++x) Draw(x, y, stride);
    }

    void Draw(int x, int y, int stride) {
        const bool uyvy = format.pixel_format == PixelFormat::kUyvy;
        std::uint8_t* const row = memory.data() + y * stride;
        const auto chroma = [&](int at) { return Wave(1 + x % 2, at, y); };
        switch (format.pixel_format) {
            case PixelFormat::kUyvy:
            case PixelFormat::kYuyv:
                row[2 * x + (uyvy ? 1 : 0)] = Wave(0, x, y);
                row[2 * x + (uyvy ? 0 : 1)] = chroma(x / 2);
                break;
            case PixelFormat::kNv12:
                row[x] = Wave(0, x, y);
                if (y % 2 == 0)
                    memory[static_cast<std::size_t>((format.height_px + y / 2) * stride + x)] =
                        Wave(1 + x % 2, x / 2, y / 2);
                break;
            default:
                row[x] = Wave(0, x, y);
                break;
        }
    }
};

struct Decoded {
    int subsampling = -1;
    int width = 0;
    int height = 0;
    std::array<std::vector<std::uint8_t>, 3> planes;
};

Decoded Decode(std::span<const std::uint8_t> jpeg) {
    const std::unique_ptr<void, int (*)(void*)> decoder(tjInitDecompress(), tjDestroy);
    Decoded decoded;
    int colours = 0;
    EXPECT_EQ(tjDecompressHeader3(decoder.get(), jpeg.data(), jpeg.size(), &decoded.width,
                                  &decoded.height, &decoded.subsampling, &colours),
              0);
    std::array<unsigned char*, 3> planes{};
    for (int i = 0; i < (decoded.subsampling == TJSAMP_GRAY ? 1 : 3); ++i) {
        auto& plane = decoded.planes.at(static_cast<std::size_t>(i));
        plane.resize(tjPlaneSizeYUV(i, decoded.width, 0, decoded.height, decoded.subsampling));
        planes.at(static_cast<std::size_t>(i)) = plane.data();
    }
    EXPECT_EQ(tjDecompressToYUVPlanes(decoder.get(), jpeg.data(), jpeg.size(), planes.data(), 0,
                                      nullptr, 0, TJFLAG_ACCURATEDCT),
              0)
        << tjGetErrorStr2(decoder.get());
    return decoded;
}

struct FormatCase {
    PixelFormat format;
    int subsampling;
    int width;
    int height;
};

class FrameJpegTest : public testing::TestWithParam<FormatCase> {};

INSTANTIATE_TEST_SUITE_P(EveryFormat, FrameJpegTest,
                         testing::Values(FormatCase{PixelFormat::kUyvy, TJSAMP_422, 320, 180},
                                         FormatCase{PixelFormat::kYuyv, TJSAMP_422, 322, 182},
                                         FormatCase{PixelFormat::kNv12, TJSAMP_420, 334, 182},
                                         FormatCase{PixelFormat::kGrey, TJSAMP_GRAY, 330, 190}));

TEST_P(FrameJpegTest, ItDecodesToTheValuesOfEveryComponent) {
    const FormatCase& c = GetParam();
    const WaveFrame frame({c.width, c.height, c.format, Range::kLimited});
    FrameJpeg encoder(frame.format, 95);
    const Decoded decoded = Decode(encoder.Compress(frame.view));
    ASSERT_EQ(decoded.subsampling, c.subsampling);
    ASSERT_EQ(decoded.width, c.width);
    ASSERT_EQ(decoded.height, c.height);
    const int rows_halved = c.subsampling == TJSAMP_420 ? 2 : 1;
    for (int i = 0; i < (c.subsampling == TJSAMP_GRAY ? 1 : 3); ++i) {
        const int width = i == 0 ? c.width : c.width / 2;
        const int height = i == 0 ? c.height : c.height / rows_halved;
        const auto& plane = decoded.planes.at(static_cast<std::size_t>(i));
        int worst = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const int value = plane.at(static_cast<std::size_t>(y * width + x));
                worst = std::max(worst, std::abs(value - Wave(i, x, y)));
            }
        EXPECT_LE(worst, 6) << "component " << i;
    }
}

TEST_P(FrameJpegTest, CompressingTakesNoMemory) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    const FormatCase& c = GetParam();
    const WaveFrame frame({c.width, c.height, c.format, Range::kFull});
    FrameJpeg encoder(frame.format, 85);
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (int i = 0; i < 3; ++i) encoder.Compress(frame.view);
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

TEST(FrameJpegLimitTest, NoiseOfTheHighestQualityFits) {
    const FrameFormat format{64, 48, PixelFormat::kUyvy, Range::kFull};
    std::vector<std::uint8_t> noise(hal::FrameBytes(format));
    std::uint32_t state = 1;
    for (std::uint8_t& byte : noise) byte = (state = state * 1664525 + 1013904223) >> 31 ? 255 : 0;
    FrameJpeg encoder(format, 100);
    const auto jpeg = encoder.Compress({format, {}, hal::PackedPlanes(format, noise.data())});
    EXPECT_EQ(Decode(jpeg).width, 64);
}

}  // namespace
}  // namespace hitchview::app
