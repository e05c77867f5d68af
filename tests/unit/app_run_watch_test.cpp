#include <gtest/gtest.h>

#include <vector>

#include "app/run_watch.hpp"
#include "drivers/lcm_receive_buffer.hpp"
#include "tests/support/heap_calls.hpp"

namespace hitchview::app {
namespace {

using hal::EventCode;
using hal::Instant;
using hal::SeamState;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// Delivers `frames` and lost some.
class CountingCamera final : public hal::Camera {
 public:
    hal::CameraCounts shown;

 private:
    [[nodiscard]] const hal::FrameFormat& DoFormat() const override { return format_; }
    hal::Result<hal::FrameLease> DoWaitFrame(milliseconds /*timeout*/) override {
        return hal::Error::kTimeout;
    }
    [[nodiscard]] hal::CameraCounts DoCounts() const override { return shown; }
    hal::FrameFormat format_{64, 32, hal::PixelFormat::kGrey, hal::Range::kFull};
};

RunWatchOptions Options(std::vector<WatchedCamera> cameras) {
    return {.health = {.version = "1.2.3", .calibration_id = "abc", .cameras = std::move(cameras)},
            .overlaps = {{true, true}},
            .period = milliseconds(33)};
}

FrameFigures Figures(std::uint64_t panoramas, Instant captured_until) {
    return {
        .panoramas = panoramas, .captured_until = captured_until, .stage_ms = {1, 2, 3, 4, 5, 6, 15}};
}

std::vector<hal::Event> TakeAll(EventQueue& queue) {
    std::vector<hal::Event> events;
    while (const auto event = queue.Take()) events.push_back(*event);
    return events;
}

TEST(RunWatchTest, BeforeTheStartNothingIsTold) {
    EventQueue events;
    RunWatch watch(Options({}), events);
    watch.Update(seconds(5), 0);
    EXPECT_FALSE(watch.MaybeHealth(seconds(5)));
}

TEST(RunWatchTest, HealthIsToldOnceASecondAlsoWhenNoPanoramaComes) {
    EventQueue events;
    RunWatch watch(Options({}), events);
    watch.Start(seconds(100));
    int told = 0;
    for (Instant now = seconds(100); now < seconds(110); now += milliseconds(10)) {
        watch.Update(now, 0);
        if (watch.MaybeHealth(now)) ++told;
    }
    EXPECT_EQ(told, 10);
    EXPECT_TRUE(watch.MaybeHealth(seconds(150)));  // the beats between are not made up for
    EXPECT_FALSE(watch.MaybeHealth(seconds(150) + milliseconds(10)));
}

TEST(RunWatchTest, RatesAndAgesAreThoseOfTheLastSecond) {
    EventQueue events;
    RunWatch watch(Options({{"front", algo::Unit::kTractor}, {"rear", algo::Unit::kTrailer}}),
                   events);
    watch.Start(seconds(100));
    ASSERT_TRUE(watch.MaybeHealth(seconds(100)));
    for (int i = 1; i <= 30; ++i) {
        FrameFigures figures =
            Figures(static_cast<std::uint64_t>(i), seconds(100) + i * milliseconds(33));
        figures.cameras_missing = i > 20 ? 2 : 0;
        figures.dropped = 3;
        figures.deadline_misses = 2;
        watch.Add(figures);
    }
    watch.Update(seconds(101), 4);
    const auto health = watch.MaybeHealth(seconds(101));
    ASSERT_TRUE(health);
    EXPECT_EQ(health->version.view(), "1.2.3");
    EXPECT_EQ(health->calibration_id.view(), "abc");
    EXPECT_DOUBLE_EQ(health->uptime_s, 1);
    EXPECT_DOUBLE_EQ(health->panoramas_per_s, 30);
    EXPECT_EQ(health->panoramas, 30U);
    EXPECT_EQ(health->dropped, 7U);
    EXPECT_EQ(health->deadline_misses, 2U);
    ASSERT_EQ(health->cameras.count, 2);
    const auto& [front, rear] = std::tie(health->cameras.items[0], health->cameras.items[1]);
    EXPECT_EQ(front.name.view(), "front");
    EXPECT_EQ(front.unit.view(), "tractor");
    EXPECT_TRUE(front.shown);
    EXPECT_DOUBLE_EQ(front.frames_per_s, 30);
    EXPECT_DOUBLE_EQ(front.age_ms, 10);
    EXPECT_EQ(rear.unit.view(), "trailer");
    EXPECT_FALSE(rear.shown);
    EXPECT_DOUBLE_EQ(rear.frames_per_s, 20);
    EXPECT_DOUBLE_EQ(rear.age_ms, 340);
    ASSERT_EQ(health->stages.count, kStages);
    EXPECT_EQ(health->stages.items[6].name.view(), "total");
    EXPECT_DOUBLE_EQ(health->stages.items[6].p50_ms, 15);
}

TEST(RunWatchTest, OfALiveCameraTheDevicesOwnCountsAreTold) {
    EventQueue events;
    CountingCamera camera;
    RunWatch watch(Options({{"front", algo::Unit::kTractor, &camera}}), events);
    watch.Start(seconds(0));
    camera.shown = {.delivered = 25, .lost = 3, .corrupted = 2, .reopened = 1};
    ASSERT_TRUE(watch.MaybeHealth(seconds(0)));
    camera.shown.delivered = 50;
    const auto health = watch.MaybeHealth(seconds(1));
    ASSERT_TRUE(health);
    const hal::CameraHealth& front = health->cameras.items[0];
    EXPECT_DOUBLE_EQ(front.frames_per_s, 25);
    EXPECT_EQ(front.delivered, 50U);
    EXPECT_EQ(front.lost, 3U);
    EXPECT_EQ(front.corrupted, 2U);
    EXPECT_EQ(front.reopened, 1U);
    EXPECT_LT(front.age_ms, 0);
}

TEST(RunWatchTest, WhatHappensToTheRunBecomesEvents) {
    EventQueue events;
    RunWatch watch(Options({}), events);
    watch.Start(seconds(0));
    FrameFigures figures = Figures(1, {});
    watch.Add(figures);
    watch.Update(seconds(1), 0);
    figures.seams = {{SeamState::kNoOverlap, SeamState::kLocked}};
    figures.matches = {{0, 33}};
    figures.deadline_misses = 1;
    watch.Add(figures);
    watch.Update(seconds(2), 5);
    const auto told = TakeAll(events);
    ASSERT_EQ(told.size(), 3U);
    EXPECT_EQ(told[0].code, EventCode::kSeamLocked);
    EXPECT_EQ(told[0].subject.view(), "right");
    EXPECT_EQ(told[0].text.view(), "aligned by 33 matches");
    EXPECT_EQ(told[1].code, EventCode::kDeadlineMissed);
    EXPECT_EQ(told[2].code, EventCode::kPanoramasDropped);
}

TEST(RunWatchTest, AnOverlapThatTheRigLacksIsNotToldOf) {
    EventQueue events;
    RunWatchOptions options = Options({});
    options.overlaps = {{false, false}};
    RunWatch watch(options, events);
    watch.Start(seconds(0));
    for (const SeamState state : {SeamState::kNoOverlap, SeamState::kLocked}) {
        FrameFigures figures;
        figures.seams = {{state, state}};
        watch.Add(figures);
    }
    watch.Update(seconds(1), 0);
    EXPECT_TRUE(TakeAll(events).empty());
}

TEST(RunWatchTest, ASmallReceiveBufferIsToldAtTheStartAndStaysAWarning) {
    EventQueue events;
    RunWatchOptions options = Options({});
    options.receive_buffer = JudgeReceiveBuffer(4'000'000, 212'992, true);
    RunWatch watch(options, events);
    watch.Start(seconds(0));
    watch.Start(seconds(1));
    const auto told = TakeAll(events);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].code, EventCode::kReceiveBufferSmall);
    const auto health = watch.MaybeHealth(seconds(0));
    ASSERT_TRUE(health);
    EXPECT_EQ(health->receive_buffer_bytes, 212'992);
    EXPECT_EQ(health->warning.view(), told[0].text.view());
}

TEST(RunWatchTest, NothingTakesMemoryAfterConstruction) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    EventQueue events;
    RunWatch watch(Options({{"front", algo::Unit::kTractor}}), events);
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    watch.Start(seconds(0));
    bool told = false;
    for (int i = 0; i < 200; ++i) {
        FrameFigures figures = Figures(static_cast<std::uint64_t>(i), i * milliseconds(33));
        figures.deadline_misses = static_cast<std::uint64_t>(i);
        figures.seams = {{i % 2 == 0 ? SeamState::kLocked : SeamState::kCoast, SeamState::kLocked}};
        watch.Add(figures);
        watch.Update(i * milliseconds(33), 0);
        told = watch.MaybeHealth(i * milliseconds(33)) || told;
        while (events.Take()) {
        }
    }
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
    EXPECT_TRUE(told);
}

TEST(ReceiveBufferTest, TheUsualPanoramaFitsTheKernelsUsualBuffer) {
    const auto verdict = JudgeReceiveBuffer(150'000, 212'992, true);
    EXPECT_EQ(verdict.budget_bytes, 150'000);
    EXPECT_TRUE(verdict.warning.view().empty());
}

TEST(ReceiveBufferTest, ALargeOneIsCutUnlessTheRigFileForbidsIt) {
    const auto cut = JudgeReceiveBuffer(4'000'000, 212'992, true);
    EXPECT_EQ(cut.budget_bytes, kUsualBufferImageBytes);
    EXPECT_EQ(cut.warning.view(),
              "net.core.rmem_max is 212992, panoramas of 4000000 bytes get lost: sysctl -w "
              "net.core.rmem_max=16777216; cut to 150000 till then");
    const auto kept = JudgeReceiveBuffer(4'000'000, 212'992, false);
    EXPECT_EQ(kept.budget_bytes, 4'000'000);
    EXPECT_FALSE(kept.warning.view().empty());
}

TEST(ReceiveBufferTest, TheShippedSettingIsEnoughAndAnUnknownOneIsNotGuessedAt) {
    EXPECT_TRUE(JudgeReceiveBuffer(4'000'000, 16'777'216, true).warning.view().empty());
    const auto unknown = JudgeReceiveBuffer(4'000'000, std::nullopt, true);
    EXPECT_EQ(unknown.budget_bytes, 4'000'000);
    EXPECT_TRUE(unknown.warning.view().empty());
}

TEST(SocketBuffersTest, AreWhatTheKernelsFilesSay) {
    const auto buffers = drivers::ReadSocketBuffers();
    ASSERT_TRUE(buffers);
    std::FILE* const file = std::fopen("/proc/sys/net/core/rmem_max", "r");
    if (file == nullptr) GTEST_SKIP() << "not shown in this network namespace";
    int bytes = 0;
    EXPECT_EQ(std::fscanf(file, "%d", &bytes), 1);
    std::fclose(file);
    EXPECT_EQ(buffers->largest_bytes, bytes);
    EXPECT_GT(buffers->usual_bytes, 0);
}

}  // namespace
}  // namespace hitchview::app
