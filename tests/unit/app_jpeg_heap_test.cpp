#include <gtest/gtest.h>

#include "app/jpeg_encoder.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/i420_picture.hpp"

namespace hitchview::app {
namespace {

using tests::HeapCallsOfThisThread;
using tests::I420Picture;

TEST(JpegHeapTest, TheCounterSeesAnAllocation) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    const std::uint64_t before = HeapCallsOfThisThread();
    const I420Picture picture(16, 16);
    EXPECT_GT(HeapCallsOfThisThread(), before);
}

TEST(JpegHeapTest, EncodingTakesNoMemoryFromTheFirstPictureOn) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    const auto calm = I420Picture::Waves(2048, 360, 0);
    const auto noise = I420Picture::Noise(2048, 360, 255, 1);
    JpegEncoder encoder(calm.format(), {});

    const std::uint64_t before = HeapCallsOfThisThread();
    bool all_encoded = true;
    for (int i = 0; i < 10; ++i) {
        all_encoded =
            encoder.Encode(calm.view()).ok() && encoder.Encode(noise.view()).ok() && all_encoded;
    }
    EXPECT_EQ(HeapCallsOfThisThread(), before);
    EXPECT_TRUE(all_encoded);
}

}  // namespace
}  // namespace hitchview::app
