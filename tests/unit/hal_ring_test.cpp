#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "hal/blocking_ring.hpp"
#include "hal/ring.hpp"

namespace hitchview::hal {
namespace {

using std::chrono::milliseconds;

TEST(RingTest, GivesBackInOrder) {
    Ring<int, 4> ring;
    EXPECT_FALSE(ring.Take());
    for (int round = 0; round < 5; ++round) {
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(ring.Append(10 * round + i));
        for (int i = 0; i < 3; ++i) EXPECT_EQ(ring.Take(), 10 * round + i);
    }
    EXPECT_FALSE(ring.Take());
}

TEST(RingTest, WhatDoesNotFitIsRefusedCountedAndLeftAlone) {
    Ring<std::unique_ptr<int>, 2> ring;
    EXPECT_TRUE(ring.Append(std::make_unique<int>(1)));
    EXPECT_TRUE(ring.Append(std::make_unique<int>(2)));
    auto third = std::make_unique<int>(3);
    EXPECT_FALSE(ring.Append(std::move(third)));
    ASSERT_TRUE(third);
    EXPECT_EQ(ring.refused(), 1U);
    EXPECT_EQ(**ring.Take(), 1);
    EXPECT_TRUE(ring.Append(std::move(third)));
    EXPECT_EQ(**ring.Take(), 2);
    EXPECT_EQ(**ring.Take(), 3);
}

TEST(RingTest, TwoThreadsLoseOnlyWhatWasRefused) {
    constexpr int kItems = 50'000;
    Ring<int, 16> ring;
    std::thread writer([&] {
        for (int i = 0; i < kItems; ++i) ring.Append(i);
        while (!ring.Append(kItems)) std::this_thread::yield();
    });
    std::uint64_t taken = 0;
    int last = -1;
    int disorder = 0;
    while (last < kItems) {
        const std::optional<int> maybe_item = ring.Take();
        if (!maybe_item) continue;
        disorder += *maybe_item <= last ? 1 : 0;
        last = *maybe_item;
        ++taken;
    }
    writer.join();
    EXPECT_EQ(disorder, 0);
    EXPECT_LE(taken, kItems + 1U);
    EXPECT_GE(taken + ring.refused(), kItems + 1U);
}

TEST(BlockingRingTest, ClosedItStillGivesWhatItHolds) {
    BlockingRing<int, 4> ring;
    EXPECT_TRUE(ring.Append(1));
    ring.Close();
    EXPECT_FALSE(ring.Append(2));
    EXPECT_FALSE(ring.finished());
    EXPECT_EQ(ring.Take(), 1);
    EXPECT_TRUE(ring.finished());
    EXPECT_FALSE(ring.Take());
}

TEST(BlockingRingTest, AWaitWithALimitEndsEmptyAndNotFinished) {
    BlockingRing<int, 4> ring;
    EXPECT_FALSE(ring.TakeFor(milliseconds(1)));
    EXPECT_FALSE(ring.finished());
}

TEST(RingTest, RemembersHowNearItCameToBeingFull) {
    Ring<int, 8> ring;
    EXPECT_EQ(ring.level().low_water, 8);
    for (int i = 0; i < 5; ++i) ring.Append(i);
    while (ring.Take()) {
    }
    ring.Append(5);
    EXPECT_EQ(ring.level().slots, 8);
    EXPECT_EQ(ring.level().low_water, 3);
}

TEST(BlockingRingTest, RemembersHowNearItCameToBeingEmpty) {
    BlockingRing<int, 8> free;
    EXPECT_EQ(free.low_water(), 8);
    for (int i = 0; i < 5; ++i) free.Append(i);
    for (int i = 0; i < 3; ++i) free.Take();
    free.Append(5);
    EXPECT_EQ(free.low_water(), 2);
}

TEST(BlockingRingTest, ClosingFreesAWriterThatWaits) {
    BlockingRing<int, 1> ring;
    EXPECT_TRUE(ring.Append(1));
    bool appended = true;
    std::thread writer([&] { appended = ring.Append(2); });
    ring.Close();
    writer.join();
    EXPECT_FALSE(appended);
}

TEST(BlockingRingTest, TwoThreadsLoseNothing) {
    constexpr int kItems = 20'000;
    BlockingRing<int, 4> ring;
    std::thread writer([&] {
        for (int i = 0; i < kItems; ++i) ring.Append(i);
        ring.Close();
    });
    int expected = 0;
    int disorder = 0;
    while (const std::optional<int> maybe_item = ring.Take()) {
        disorder += *maybe_item != expected++ ? 1 : 0;
    }
    writer.join();
    EXPECT_EQ(disorder, 0);
    EXPECT_EQ(expected, kItems);
}

}  // namespace
}  // namespace hitchview::hal
