#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <deque>
#include <future>
#include <string>
#include <thread>

#include "app/telemetry_thread.hpp"
#include "hal/fake_can_bus.hpp"
#include "hal/fake_clock.hpp"
#include "tests/support/heap_calls.hpp"

namespace hitchview::app {
namespace {

using hal::CanFrame;
using hal::Error;
using hal::HitchAngle;
using hal::Instant;
using std::chrono::milliseconds;

constexpr TelemetryOptions kLive{.paced = false, .retry_after = milliseconds(1)};

// Whole degrees in the first byte, to 100.
HitchAngleSignal ByteSignal() {
    return {.id = 7, .length_bits = 8, .factor_deg = 1};
}

// Received at millisecond `i`, shows `i` degrees.
CanFrame FrameAt(int i) {
    CanFrame frame{.id = 7, .size_bytes = 1, .received_at = milliseconds(i)};
    frame.data[0] = static_cast<std::uint8_t>(i % 100);
    return frame;
}

std::deque<hal::Result<CanFrame>> FramesUpTo(int last) {
    std::deque<hal::Result<CanFrame>> script;
    for (int i = 0; i <= last; ++i) script.emplace_back(FrameAt(i));
    return script;
}

// Waits for what must come; a hang is ended by the time limit of the test.
HitchAngle WaitTake(TelemetryThread& telemetry) {
    while (true) {
        if (const auto maybe_angle = telemetry.Take()) return *maybe_angle;
        std::this_thread::yield();
    }
}

template <typename Condition>
void WaitUntil(const Condition& condition) {
    while (!condition()) std::this_thread::yield();
}

TEST(TelemetryThreadTest, ALiveBusIsHandedOverInOrderWithoutAdvance) {
    hal::FakeCanBus bus(FramesUpTo(50));
    TelemetryThread telemetry(bus, ByteSignal(), kLive);
    for (int i = 0; i <= 50; ++i) {
        const HitchAngle angle = WaitTake(telemetry);
        EXPECT_EQ(angle.received_at, milliseconds(i));
        EXPECT_EQ(angle.quality, hal::HitchAngleQuality::kValid);
    }
    EXPECT_FALSE(telemetry.Take());
}

TEST(TelemetryThreadTest, WhatWasLetGoOfCanBeTakenWhenItHasSettled) {
    for (const int last : {40, 99}) {  // in the middle of the recording and behind its end
        hal::FakeCanBus bus(FramesUpTo(80));
        TelemetryThread telemetry(bus, ByteSignal(), {});
        telemetry.Advance(milliseconds(last));
        telemetry.Settle();
        int taken = 0;
        while (telemetry.Take()) ++taken;
        EXPECT_EQ(taken, std::min(last, 80) + 1);
    }
}

TEST(TelemetryThreadTest, ARecordingIsHandedOverOnlyAsFarAsTheFrameSetsHaveCome) {
    hal::FakeCanBus bus(FramesUpTo(99));
    TelemetryThread telemetry(bus, ByteSignal(), {});
    WaitUntil([&] { return telemetry.counts().frames >= 1; });
    ASSERT_FALSE(telemetry.Take());
    for (int reached = 9; reached <= 99; reached += 10) {
        telemetry.Advance(milliseconds(reached));
        for (int i = reached - 9; i <= reached; ++i) {
            ASSERT_EQ(WaitTake(telemetry).received_at, milliseconds(i));
        }
        // The next frame is there, and held.
        WaitUntil(
            [&] { return telemetry.counts().frames >= std::min<std::uint64_t>(reached + 2, 100); });
        ASSERT_FALSE(telemetry.Take());
    }
    WaitUntil([&] { return telemetry.counts().angles == 100; });
}

TEST(TelemetryThreadTest, AdvanceToAnEarlierMomentChangesNothing) {
    hal::FakeCanBus bus(FramesUpTo(9));
    TelemetryThread telemetry(bus, ByteSignal(), {});
    telemetry.Advance(milliseconds(9));
    telemetry.Advance(milliseconds(1));
    for (int i = 0; i <= 9; ++i) EXPECT_EQ(WaitTake(telemetry).received_at, milliseconds(i));
}

TEST(TelemetryThreadTest, FramesOfOtherIdsAreCountedAndHoldNothingUp) {
    CanFrame other = FrameAt(1000);
    other.id = 8;
    hal::FakeCanBus bus({other, FrameAt(1), other});
    TelemetryThread telemetry(bus, ByteSignal(), {});
    telemetry.Advance(milliseconds(1));
    EXPECT_EQ(WaitTake(telemetry).received_at, milliseconds(1));
    WaitUntil([&] { return telemetry.counts().frames == 3; });
    EXPECT_EQ(telemetry.counts().angles, 1U);
}

TEST(TelemetryThreadTest, ADisconnectedBusIsTriedAgainAndCounted) {
    hal::FakeCanBus bus({Error::kDisconnected, Error::kTimeout, Error::kDisconnected, FrameAt(1)});
    TelemetryThread telemetry(bus, ByteSignal(), kLive);
    EXPECT_EQ(WaitTake(telemetry).received_at, milliseconds(1));
    EXPECT_EQ(telemetry.counts().failures, 2U);
}

TEST(TelemetryThreadTest, AGapInARecordingIsToldBeforeTheFrameThatEndsIt) {
    hal::FakeCanBus bus({FrameAt(1), FrameAt(5000)});
    TelemetryThread telemetry(bus, ByteSignal(), {});
    telemetry.Advance(milliseconds(5000));
    EXPECT_EQ(WaitTake(telemetry).received_at, milliseconds(1));
    const HitchAngle stale = WaitTake(telemetry);
    EXPECT_EQ(stale.quality, hal::HitchAngleQuality::kStale);
    EXPECT_EQ(stale.received_at, milliseconds(1001));
    EXPECT_EQ(WaitTake(telemetry).received_at, milliseconds(5000));
}

TEST(TelemetryThreadTest, ALiveBusThatFallsSilentIsToldByTheClock) {
    hal::FakeClock clock;
    clock.Advance(milliseconds(500));
    hal::FakeCanBus bus({FrameAt(1), Error::kTimeout, Error::kDisconnected, FrameAt(600)});
    TelemetryOptions options = kLive;
    options.clock = &clock;
    HitchAngleSignal signal = ByteSignal();
    signal.max_age = milliseconds(100);
    TelemetryThread telemetry(bus, signal, options);
    EXPECT_EQ(WaitTake(telemetry).quality, hal::HitchAngleQuality::kValid);
    EXPECT_EQ(WaitTake(telemetry).quality, hal::HitchAngleQuality::kStale);
    EXPECT_EQ(WaitTake(telemetry).received_at, milliseconds(600));
}

TEST(TelemetryThreadTest, WhatNobodyTakesIsRefusedAndCounted) {
    constexpr int kExcess = 10;
    constexpr int kCapacity = TelemetryThread::kCapacity;
    hal::FakeCanBus bus(FramesUpTo(kCapacity + kExcess - 1));
    TelemetryThread telemetry(bus, ByteSignal(), kLive);
    WaitUntil([&] { return telemetry.counts().refused == kExcess; });
    EXPECT_EQ(telemetry.counts().angles, kCapacity);
    EXPECT_EQ(WaitTake(telemetry).received_at, milliseconds(0));
}

TEST(TelemetryThreadTest, EndsWhileAFrameIsHeldBack) {
    hal::FakeCanBus bus(FramesUpTo(9));
    TelemetryThread telemetry(bus, ByteSignal(), {});
    WaitUntil([&] { return telemetry.counts().frames >= 1; });
}

TEST(TelemetryThreadTest, EndsWithoutWaitingForTheNextTry) {
    hal::FakeCanBus bus({Error::kDisconnected, FrameAt(1)});
    TelemetryThread telemetry(bus, ByteSignal(), {.retry_after = std::chrono::hours(1)});
    WaitUntil([&] { return telemetry.counts().failures == 1; });
}

// Says on which thread it is called and what that thread took from the heap between two calls.
class WatchedCanBus final : public hal::CanBus {
 public:
    static constexpr int kFrames = 500;

    std::promise<std::string> thread_name;
    std::promise<std::uint64_t> heap_calls;

 private:
    hal::Result<CanFrame> DoWaitFrame(milliseconds /*timeout*/) override {
        if (next_ == 0) {
            std::array<char, 16> name{};
            pthread_getname_np(pthread_self(), name.data(), name.size());
            thread_name.set_value(name.data());
            before_ = tests::HeapCallsOfThisThread();
        }
        if (next_ == kFrames) {
            heap_calls.set_value(tests::HeapCallsOfThisThread() - before_);
            return Error::kEndOfStream;
        }
        if (next_++ % 10 == 5) return Error::kDisconnected;
        return FrameAt(next_);
    }

    int next_ = 0;
    std::uint64_t before_ = 0;
};

TEST(TelemetryThreadTest, TheThreadIsNamedCan) {
    WatchedCanBus bus;
    const TelemetryThread telemetry(bus, ByteSignal(), kLive);
    EXPECT_EQ(bus.thread_name.get_future().get(), "can");
}

TEST(TelemetryThreadTest, TakesNoMemoryOnceItRuns) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    WatchedCanBus bus;
    TelemetryThread telemetry(bus, ByteSignal(), {.retry_after = milliseconds(1)});
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (int i = 0; i <= WatchedCanBus::kFrames; ++i) {
        telemetry.Advance(milliseconds(i));
        telemetry.Take();
    }
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
    EXPECT_EQ(bus.heap_calls.get_future().get(), 0U);
}

}  // namespace
}  // namespace hitchview::app
