#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <random>
#include <string>
#include <thread>

#include "app/record_ring.hpp"

namespace hitchview::app {
namespace {

using namespace std::chrono_literals;
using WhenFull = RecordRing::WhenFull;

constexpr std::size_t kRingBytes = 64 << 10;

std::vector<std::uint8_t> Bytes(std::uint32_t seed, std::size_t count) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> bytes(count);
    std::ranges::generate(bytes, [&] { return static_cast<std::uint8_t>(random()); });
    return bytes;
}

bool Put(RecordRing& ring, std::int64_t utime_us, const std::string& channel,
         const std::vector<std::uint8_t>& bytes) {
    const auto place = ring.Reserve(utime_us, channel, bytes.size());
    if (!place) return false;
    std::ranges::copy(bytes, place->data.begin());
    ring.Commit(*place, bytes.size());
    return true;
}

struct Taken {
    std::int64_t utime_us = 0;
    std::string channel;
    std::vector<std::uint8_t> data;

    bool operator==(const Taken&) const = default;
};

std::optional<Taken> Take(RecordRing& ring) {
    const auto event = ring.Front(0ms);
    if (!event) return std::nullopt;
    Taken taken{
        event->utime_us, std::string(event->channel), {event->data.begin(), event->data.end()}};
    ring.Pop();
    return taken;
}

TEST(RecordRingTest, EventsOfAnySizeComeOutAsTheyWentIn) {
    RecordRing ring(kRingBytes);
    std::deque<Taken> expected;
    std::mt19937 random(3);
    int refused = 0;
    for (int i = 0; i < 5000; ++i) {
        const auto size = static_cast<std::size_t>(random() % 9000);
        const Taken event{i, std::string(1, static_cast<char>('A' + i % 7)),
                          Bytes(static_cast<std::uint32_t>(i), size)};
        if (event.data.empty()) continue;
        if (Put(ring, event.utime_us, event.channel, event.data))
            expected.push_back(event);
        else
            ++refused;
        while (random() % 3 == 0 && !expected.empty()) {
            ASSERT_EQ(Take(ring), expected.front());
            expected.pop_front();
        }
    }
    for (const Taken& event : expected) ASSERT_EQ(Take(ring), event);
    EXPECT_EQ(Take(ring), std::nullopt);
    EXPECT_GT(refused, 100);
    EXPECT_EQ(ring.used_bytes(), 0U);
}

TEST(RecordRingTest, WhatIsBehindAnUnfinishedEventWaits) {
    RecordRing ring(kRingBytes);
    const auto slow = ring.Reserve(1, "SLOW", 10);
    ASSERT_TRUE(slow);
    ASSERT_TRUE(Put(ring, 2, "QUICK", Bytes(1, 10)));
    EXPECT_EQ(Take(ring), std::nullopt);
    ring.Commit(*slow, 4);
    EXPECT_EQ(Take(ring)->data.size(), 4U);
    EXPECT_EQ(Take(ring)->channel, "QUICK");
}

TEST(RecordRingTest, AnEventThatIsGivenUpLeavesNoTrace) {
    RecordRing ring(kRingBytes);
    const auto place = ring.Reserve(1, "A", 100);
    ASSERT_TRUE(place);
    ring.Commit(*place, 0);
    ASSERT_TRUE(Put(ring, 2, "B", Bytes(1, 10)));
    EXPECT_EQ(Take(ring)->channel, "B");
}

TEST(RecordRingTest, AnEventLargerThanHalfOfItIsRefusedAndNobodyWaitsForRoom) {
    RecordRing ring(kRingBytes);
    ring.SetWhenFull(WhenFull::kWait);
    EXPECT_FALSE(ring.Reserve(1, "A", kRingBytes / 2 + 1));
}

TEST(RecordRingTest, TheNewestAreKeptInOrderWhereTheOldestGo) {
    RecordRing ring(kRingBytes);
    ring.SetWhenFull(WhenFull::kDropOldest);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(Put(ring, i, "A", Bytes(1, 100 + i)));
    const auto oldest = Take(ring);
    ASSERT_TRUE(oldest);
    EXPECT_GT(oldest->utime_us, 900);
    std::int64_t next = oldest->utime_us + 1;
    while (const auto event = Take(ring)) ASSERT_EQ(event->utime_us, next++);
    EXPECT_EQ(next, 1000);
    // All that fits was kept: one more of that size would not have fitted.
    EXPECT_LT((1000 - oldest->utime_us + 1) * (1100 + 256), std::int64_t{2 * kRingBytes});
    EXPECT_GT((1000 - oldest->utime_us + 2) * (1100 + 256), std::int64_t{kRingBytes});
}

TEST(RecordRingTest, WhatIsTooOldIsDroppedUpToTheFirstThatIsNot) {
    RecordRing ring(kRingBytes);
    for (const int utime : {1, 2, 7, 3, 8}) ASSERT_TRUE(Put(ring, utime, "A", Bytes(1, 10)));
    ring.DropBefore(5);
    for (const int utime : {7, 3, 8}) EXPECT_EQ(Take(ring)->utime_us, utime);
}

TEST(RecordRingTest, WritersWaitForRoomAndNothingIsLost) {
    RecordRing ring(kRingBytes);
    ring.SetWhenFull(WhenFull::kWait);
    constexpr int kEvents = 3000;
    std::vector<std::thread> writers;
    for (const char* channel : {"A", "B", "C"}) {
        writers.emplace_back([&ring, channel] {
            for (int i = 0; i < kEvents; ++i) Put(ring, i, channel, Bytes(1, 1 + i % 2000));
        });
    }
    std::map<std::string, std::int64_t> next;
    for (int i = 0; i < 3 * kEvents; ++i) {
        const auto event = ring.Front(60s);
        ASSERT_TRUE(event);
        ASSERT_EQ(event->utime_us, next[std::string(event->channel)]++);
        ring.Pop();
    }
    for (std::thread& writer : writers) writer.join();
}

TEST(RecordRingTest, ClosingLetsWaitingWritersGoAndKeepsWhatIsIn) {
    RecordRing ring(kRingBytes);
    ring.SetWhenFull(WhenFull::kWait);
    std::int64_t put = 0;
    std::thread writer([&] {
        while (Put(ring, put, "A", Bytes(1, 5000))) ++put;
    });
    while (ring.used_bytes() + 5200 < kRingBytes) std::this_thread::yield();
    ring.Close();
    writer.join();
    EXPECT_FALSE(ring.finished());
    std::int64_t taken = 0;
    while (Take(ring)) ++taken;
    EXPECT_EQ(taken, put);
    EXPECT_TRUE(ring.finished());
}

}  // namespace
}  // namespace hitchview::app
