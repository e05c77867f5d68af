#include <gtest/gtest.h>

#include <map>
#include <string>
#include <thread>
#include <vector>

#include "app/event_queue.hpp"
#include "app/panorama_publisher.hpp"
#include "drivers/steady_clock.hpp"
#include "hal/fake_event_log.hpp"
#include "hal/fake_publisher.hpp"

namespace hitchview::app {
namespace {

using hal::Event;
using hal::EventCode;

Event Numbered(std::int64_t number, const char* subject = "front") {
    return {.code = EventCode::kCameraLost,
            .when = hal::Instant(number),
            .subject = std::string_view(subject)};
}

TEST(EventQueueTest, GivesEventsInTheirOrderManyTimesRound) {
    EventQueue queue;
    for (std::int64_t i = 0; i < 1000; ++i) {
        EXPECT_TRUE(queue.Put(Numbered(2 * i)));
        EXPECT_TRUE(queue.Put(Numbered(2 * i + 1)));
        EXPECT_EQ(queue.Take()->when.count(), 2 * i);
        EXPECT_EQ(queue.Take()->when.count(), 2 * i + 1);
        EXPECT_FALSE(queue.Take());
    }
}

TEST(EventQueueTest, WhatDoesNotFitIsRefusedAndCountedAndTheRestIsKept) {
    constexpr auto kCapacity = static_cast<std::int64_t>(EventQueue::kCapacity);
    EventQueue queue;
    for (std::int64_t i = 0; i < kCapacity; ++i) EXPECT_TRUE(queue.Put(Numbered(i)));
    EXPECT_FALSE(queue.Put(Numbered(kCapacity)));
    EXPECT_EQ(queue.counts().refused, 1U);

    EXPECT_EQ(queue.Take()->when.count(), 0);
    EXPECT_TRUE(queue.Put(Numbered(-1)));
    for (std::int64_t i = 1; i < kCapacity; ++i) EXPECT_EQ(queue.Take()->when.count(), i);
    EXPECT_EQ(queue.Take()->when.count(), -1);
    EXPECT_FALSE(queue.Take());
}

TEST(EventQueueTest, CountsWhatHappenedByCodeAlsoWhatWasRefused) {
    EventQueue queue;
    for (std::size_t i = 0; i < EventQueue::kCapacity; ++i) queue.Put(Numbered(0));
    queue.Put({.code = EventCode::kCameraBack});
    const EventCounts counts = queue.counts();
    EXPECT_EQ(counts.happened[0], EventQueue::kCapacity);
    EXPECT_EQ(counts.happened[1], 1U);
    EXPECT_EQ(counts.refused, 1U);
}

TEST(EventQueueTest, EveryEventOfManyThreadsIsTakenOnceAndInItsThreadsOrderOrIsRefused) {
    constexpr std::int64_t kEach = 5000;
    const std::vector<const char*> writers{"a", "b", "c", "d"};
    EventQueue queue;
    std::atomic<std::size_t> ended{0};
    std::vector<std::thread> threads;
    for (const char* writer : writers) {
        threads.emplace_back([&queue, &ended, writer] {
            for (std::int64_t i = 0; i < kEach; ++i) {
                if (!queue.Put(Numbered(i, writer))) std::this_thread::yield();
            }
            ++ended;
        });
    }
    std::map<std::string, std::int64_t> newest;
    std::uint64_t taken = 0;
    while (true) {
        const bool last = ended == writers.size();  // before the queue is looked at
        const auto event = queue.Take();
        if (!event && last) break;
        if (!event) continue;
        auto [known, first] = newest.try_emplace(std::string(event->subject.view()), -1);
        EXPECT_GT(event->when.count(), known->second);
        known->second = event->when.count();
        ++taken;
    }
    for (std::thread& thread : threads) thread.join();
    const EventCounts counts = queue.counts();
    EXPECT_EQ(counts.happened[0], writers.size() * kEach);
    EXPECT_EQ(taken + counts.refused, counts.happened[0]);
    EXPECT_GT(taken, 0U);
}

TEST(EventQueueTest, TheLogIsToldOfEveryEventAlsoOfThoseThatDoNotFit) {
    hal::FakeEventLog log(true);
    EventQueue queue(&log);
    for (int i = 0; i < static_cast<int>(EventQueue::kCapacity) + 1; ++i)
        queue.Put(Numbered(i, "front"));
    EXPECT_EQ(queue.counts().refused, 1U);
    ASSERT_EQ(log.events().size(), EventQueue::kCapacity + 1);
    EXPECT_EQ(log.events().back().subject.view(), "front");
}

TEST(EventQueueTest, WhatIsPutIsOnStderrOnlyIfThatIsInTheLogToo) {
    hal::FakeEventLog with(true);
    hal::FakeEventLog without(false);
    EXPECT_TRUE(EventQueue(&with).is_on_stderr());
    EXPECT_FALSE(EventQueue(&without).is_on_stderr());
    EXPECT_FALSE(EventQueue().is_on_stderr());
}

TEST(EventQueueTest, ThePublisherSendsWhatIsPut) {
    EventQueue queue;
    hal::FakePublisher network;
    const drivers::SteadyClock clock;
    PanoramaPublisher publisher(network, clock, {.events = &queue},
                                {64, 64, hal::PixelFormat::kI420, hal::Range::kFull}, {});
    queue.Put(Numbered(1, "front"));
    queue.Put(Numbered(2, "rear"));
    while (publisher.published() < 2) std::this_thread::yield();
    publisher.Finish();
    ASSERT_EQ(network.events.size(), 2U);
    EXPECT_EQ(network.events[0].subject.view(), "front");
    EXPECT_EQ(network.events[1].subject.view(), "rear");
}

}  // namespace
}  // namespace hitchview::app
