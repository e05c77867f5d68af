#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "drivers/frame_jpeg_decoder.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/jpeg_picture.hpp"

namespace hitchview::drivers {
namespace {

using tests::Bytes;
using tests::JpegPicture;

constexpr hal::FrameFormat Format(int width, int height) {
    return {width, height, hal::PixelFormat::kNv12, hal::Range::kFull};
}

hal::Checked<Bytes> Decoded(FrameJpegDecoder& decoder, const hal::FrameFormat& format,
                            const Bytes& jpeg) {
    Bytes nv12(hal::FrameBytes(format));
    if (const auto decoded = decoder.Decode(jpeg, nv12); !decoded) {
        return std::string(ToString(decoded.error()));
    }
    return nv12;
}

/// Samples of the reference's planes, chroma averaged down to half size.
Bytes HalfChroma(const tests::JpegPlanes& planes, int width, int height) {
    Bytes nv12 = planes.samples[0];
    const std::size_t luma = nv12.size();
    nv12.resize(luma * 3 / 2);
    for (std::size_t k = 1; k < 3; ++k) {
        const int plane_width = planes.width[k];
        const int across = plane_width == width ? 2 : 1;
        const int down = planes.height[k] == height ? 2 : 1;
        for (int y = 0; y < height / 2; ++y) {
            for (int x = 0; x < width / 2; ++x) {
                int sum = 0;
                for (int i = 0; i < 4; ++i) {
                    const int from_x = x * across + (across == 2 ? i % 2 : 0);
                    const int from_y = y * down + (down == 2 ? i / 2 : 0);
                    sum +=
                        planes.samples[k][static_cast<std::size_t>(from_y * plane_width + from_x)];
                }
                nv12[luma + static_cast<std::size_t>(y * width + 2 * x) + k - 1] =
                    static_cast<std::uint8_t>((sum + 2) / 4);
            }
        }
    }
    return nv12;
}

class FrameJpegSamplingTest : public testing::TestWithParam<int> {};

TEST_P(FrameJpegSamplingTest, DecodesToTheReferencesPlanesWithChromaAveraged) {
    for (const auto& [width, height] : {std::pair{64, 48}, std::pair{50, 38}}) {
        const Bytes jpeg = JpegPicture(width, height, GetParam(), 1);
        FrameJpegDecoder decoder(Format(width, height));
        const auto nv12 = Decoded(decoder, Format(width, height), jpeg);
        ASSERT_TRUE(nv12.ok()) << nv12.error();
        EXPECT_EQ(nv12.value(), HalfChroma(tests::ReferencePlanes(jpeg), width, height));
    }
}

INSTANTIATE_TEST_SUITE_P(Samplings, FrameJpegSamplingTest,
                         testing::Values(TJSAMP_420, TJSAMP_422, TJSAMP_440, TJSAMP_444));

class FrameJpegDecoderTest : public testing::Test {
 protected:
    hal::Checked<Bytes> Decode(const Bytes& jpeg) { return Decoded(decoder_, kFormat, jpeg); }

    static constexpr hal::FrameFormat kFormat = Format(64, 48);
    FrameJpegDecoder decoder_{kFormat};
    const Bytes good_ = JpegPicture(64, 48, TJSAMP_422, 1);
};

TEST_F(FrameJpegDecoderTest, GreyHasNeutralChroma) {
    const auto nv12 = Decode(JpegPicture(64, 48, TJSAMP_GRAY, 1));
    ASSERT_TRUE(nv12.ok()) << nv12.error();
    EXPECT_EQ(Bytes(nv12.value().begin() + 64 * 48, nv12.value().end()), Bytes(64 * 24, 128));
}

TEST_F(FrameJpegDecoderTest, PicturesWithoutHuffmanTablesAreDecodedWithTheStandardOnes) {
    const Bytes bare = tests::WithoutHuffmanTables(good_);
    ASSERT_LT(bare.size(), good_.size());
    FrameJpegDecoder fresh(kFormat);
    const auto nv12 = Decoded(fresh, kFormat, bare);
    ASSERT_TRUE(nv12.ok()) << nv12.error();
    EXPECT_EQ(nv12.value(), Decode(good_).value());
}

TEST_F(FrameJpegDecoderTest, APictureWithoutQuantisationTablesDoesNotGetThoseOfTheOneBefore) {
    Bytes bare = good_;
    for (std::size_t i = 0; i + 1 < bare.size(); ++i) {
        if (bare[i] == 0xFF && bare[i + 1] == 0xDB) bare[i + 1] = 0xEF;  // now application data
    }
    EXPECT_FALSE(Decode(bare).ok());
    EXPECT_TRUE(Decode(good_).ok());
    EXPECT_FALSE(Decode(bare).ok());
}

TEST_F(FrameJpegDecoderTest, WhatIsNotAWholePictureOfTheSizeIsCorruptedAndTheNextIsGood) {
    const Bytes cut(good_.begin(), good_.begin() + static_cast<std::ptrdiff_t>(good_.size() / 2));
    const Bytes other = JpegPicture(32, 48, TJSAMP_422, 1);
    for (const Bytes& damaged : {cut, other, Bytes{}, Bytes{0xFF, 0xD8}, Bytes(500, 0)}) {
        EXPECT_EQ(Decode(damaged).ok(), false);
        EXPECT_TRUE(Decode(good_).ok());
    }
}

TEST_F(FrameJpegDecoderTest, AnyDamageIsSurvived) {
    std::uint32_t random = 1;
    for (int i = 0; i < 3000; ++i) {
        Bytes damaged = good_;
        for (int k = 0; k < 3; ++k) {
            random = random * 1664525U + 1013904223U;
            damaged[(random >> 8U) % damaged.size()] = static_cast<std::uint8_t>(random >> 3U);
        }
        static_cast<void>(Decode(damaged).ok());
    }
    EXPECT_TRUE(Decode(good_).ok());
}

TEST_F(FrameJpegDecoderTest, PaddingAfterThePictureDoesNotHarm) {
    Bytes padded = good_;
    padded.resize(padded.size() + 100, 0);
    EXPECT_TRUE(Decode(padded).ok());
}

TEST_F(FrameJpegDecoderTest, TakesNoMemoryNotEvenForDamagedPictures) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    const Bytes cut(good_.begin(), good_.begin() + 200);
    Bytes nv12(hal::FrameBytes(kFormat));
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (int i = 0; i < 20; ++i) {
        static_cast<void>(decoder_.Decode(good_, nv12).ok());
        static_cast<void>(decoder_.Decode(cut, nv12).ok());
    }
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

}  // namespace
}  // namespace hitchview::drivers
