#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "app/frame_tap.hpp"
#include "app/tapped_camera.hpp"
#include "hal/fake_camera.hpp"
#include "tests/support/heap_calls.hpp"

namespace hitchview::app {
namespace {

constexpr hal::FrameFormat kFormat{16, 8, hal::PixelFormat::kGrey, hal::Range::kFull};

/// A pool whose frames go through a tap.
class FrameTapTest : public testing::Test {
 protected:
    static constexpr int kSlots = 12;

    hal::FrameLease Frame(std::uint32_t sequence) {
        const auto slot = pool_.Take();
        EXPECT_TRUE(slot);
        std::ranges::fill(slot->bytes, static_cast<std::uint8_t>(sequence));
        return tap_.Offer(pool_.Lease(*slot, {.sequence = sequence}));
    }

    hal::FramePool pool_{kFormat, kSlots};
    FrameTap tap_;
    WorkBell bell_;
};

TEST_F(FrameTapTest, AFrameGoesBackWhenBothReadersAreDone) {
    tap_.Open(FrameTap::WhenFull::kDrop, 1, bell_);
    hal::FrameLease first = Frame(7);
    auto second = tap_.Take();
    ASSERT_TRUE(second);
    EXPECT_EQ(first.view().planes[0].data, second->view().planes[0].data);
    EXPECT_EQ(second->view().header.sequence, 7U);
    first.Release();
    EXPECT_EQ(pool_.free_count(), kSlots - 1);
    EXPECT_EQ(second->view().planes[0].data[5], 7);
    second->Release();
    EXPECT_EQ(pool_.free_count(), kSlots);
}

TEST_F(FrameTapTest, ClosedItIsNotThere) {
    EXPECT_TRUE(Frame(1));
    EXPECT_FALSE(tap_.Take());
    EXPECT_EQ(tap_.counts().offered, 0U);
    EXPECT_EQ(pool_.free_count(), kSlots);
}

TEST_F(FrameTapTest, AReaderThatIsBehindMissesFramesAndNobodyWaits) {
    tap_.Open(FrameTap::WhenFull::kDrop, 1, bell_);
    for (std::uint32_t i = 0; i < 10; ++i) EXPECT_TRUE(Frame(i));
    EXPECT_EQ(tap_.counts().offered, 10U);
    EXPECT_EQ(tap_.counts().dropped, 10 - FrameTap::kCapacity);
    EXPECT_EQ(pool_.free_count(), kSlots - static_cast<int>(FrameTap::kCapacity));
    for (std::uint32_t i = 0; i < FrameTap::kCapacity; ++i)
        EXPECT_EQ(tap_.Take()->view().header.sequence, i);
    EXPECT_EQ(pool_.free_count(), kSlots);
}

TEST_F(FrameTapTest, OfEveryThirdFrameTheNumberDecides) {
    tap_.Open(FrameTap::WhenFull::kDrop, 3, bell_);
    for (std::uint32_t i = 1; i < 10; ++i) Frame(i);
    for (const std::uint32_t sequence : {3U, 6U, 9U})
        EXPECT_EQ(tap_.Take()->view().header.sequence, sequence);
    EXPECT_FALSE(tap_.Take());
}

TEST_F(FrameTapTest, WhereNothingMayBeLostTheCameraWaits) {
    constexpr std::uint32_t kFrames = 200;
    tap_.Open(FrameTap::WhenFull::kWait, 1, bell_);
    std::thread camera([this] {
        for (std::uint32_t i = 0; i < kFrames; ++i) Frame(i);
    });
    for (std::uint32_t next = 0; next < kFrames;) {
        const std::uint32_t rings = bell_.rings();
        auto frame = tap_.Take();
        if (!frame) {
            bell_.WaitWhile(rings);
            continue;
        }
        ASSERT_EQ(frame->view().header.sequence, next++);
    }
    camera.join();
    EXPECT_EQ(tap_.counts().dropped, 0U);
    EXPECT_EQ(pool_.free_count(), kSlots);
}

TEST_F(FrameTapTest, ClosingLetsAWaitingCameraGo) {
    tap_.Open(FrameTap::WhenFull::kWait, 1, bell_);
    std::thread camera([this] {
        for (std::uint32_t i = 0; i <= FrameTap::kCapacity; ++i) Frame(i);
    });
    while (tap_.counts().offered <= FrameTap::kCapacity) std::this_thread::yield();
    tap_.Close();
    camera.join();
    EXPECT_EQ(tap_.counts().dropped, 1U);
}

TEST_F(FrameTapTest, AReaderThatGivesNothingBackGetsNoMoreAndTheCameraGoesOn) {
    constexpr std::uint32_t kMost = 64;
    hal::FramePool large(kFormat, kMost);
    std::vector<hal::FrameLease> held;
    tap_.Open(FrameTap::WhenFull::kDrop, 1, bell_);
    for (std::uint32_t i = 0; i < kMost; ++i) {
        tap_.Offer(large.Lease(*large.Take(), {.sequence = i}));
        held.push_back(std::move(*tap_.Take()));
    }
    EXPECT_EQ(tap_.counts().dropped, 0U);
    {
        const hal::FrameLease more = Frame(kMost);
        EXPECT_EQ(more.view().header.sequence, kMost);
        EXPECT_FALSE(tap_.Take());
        EXPECT_EQ(tap_.counts().dropped, 1U);
    }
    EXPECT_EQ(pool_.free_count(), kSlots);
    held.clear();
    Frame(kMost + 1);
    EXPECT_TRUE(tap_.Take());
}

TEST_F(FrameTapTest, NoMemoryIsTaken) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    tap_.Open(FrameTap::WhenFull::kDrop, 1, bell_);
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (std::uint32_t i = 0; i < 100; ++i) {
        Frame(i);
        tap_.Take();
    }
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

TEST(TappedCameraTest, ItAnswersAsItsCameraDoes) {
    TappedCamera camera(std::make_unique<hal::FakeCamera>(
        kFormat, std::deque<hal::Result<hal::FakeFrame>>{hal::FakeFrame{.header = {.sequence = 4}},
                                                         hal::Error::kDisconnected}));
    WorkBell bell;
    camera.tap().Open(FrameTap::WhenFull::kDrop, 1, bell);
    EXPECT_EQ(camera.format(), kFormat);
    {
        const auto frame = camera.WaitFrame(std::chrono::milliseconds(1));
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame.value().view().header.sequence, 4U);
    }
    EXPECT_EQ(camera.WaitFrame(std::chrono::milliseconds(1)).error(), hal::Error::kDisconnected);
    EXPECT_EQ(camera.Reopen().error(), hal::Error::kUnsupported);
    EXPECT_EQ(camera.loss(), hal::CameraLoss::kDisconnected);
    EXPECT_EQ(camera.counts().delivered, 0U);
    EXPECT_EQ(camera.pool().slots, 0);
    EXPECT_TRUE(camera.tap().Take());
}

}  // namespace
}  // namespace hitchview::app
