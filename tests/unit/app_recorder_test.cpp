#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <numeric>
#include <thread>

#include "app/log_channels.hpp"
#include "app/recorder.hpp"
#include "app/tapped_camera.hpp"
#include "hal/fake_clock.hpp"
#include "tests/support/pattern_camera.hpp"
#include "tests/support/recorded_events.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr hal::FrameFormat kFormat{64, 32, hal::PixelFormat::kUyvy, hal::Range::kLimited};
constexpr hal::Instant kPeriod = milliseconds(100);
constexpr std::int64_t kEpoch_us = hal::FakeClock::kEpochAtZero.count() / 1000;

/// Three cameras with a recorder beside them.
class Drive {
 public:
    explicit Drive(const std::string& folder, RecorderOptions options = {}) {
        options.folder.folder = folder;
        options.frames.raw = true;
        drivers::RecordedRig rig{.rig_yaml = "schema: 1\n", .period_ms = 100};
        std::vector<RecordedCamera> recorded;
        for (const char* name : {"front", "left", "right"}) {
            auto camera = std::make_unique<tests::PatternCamera>(recorded.size(), kFormat, kPeriod);
            cameras_.push_back(std::make_unique<TappedCamera>(std::move(camera)));
            recorded.push_back({name, CameraChannel(name), kFormat, &cameras_.back()->tap()});
            rig.cameras.emplace_back(name);
            rig.camera_channels.push_back(CameraChannel(name));
        }
        auto opened = Recorder::Open(options, rig, recorded, clock, events);
        EXPECT_TRUE(opened) << opened.error();
        recorder = std::move(opened.value());
    }

    /// So many frames of each camera.
    void Run(int frames) {
        for (int i = 0; i < frames; ++i)
            for (const auto& camera : cameras_) EXPECT_TRUE(camera->WaitFrame(milliseconds(1)));
    }

    std::vector<hal::Event> Events() {
        std::vector<hal::Event> all;
        while (const auto event = events.Take()) all.push_back(*event);
        return all;
    }

    hal::FakeClock clock;
    EventQueue events;

 private:
    std::vector<std::unique_ptr<TappedCamera>> cameras_;

 public:
    std::unique_ptr<Recorder> recorder;  // last: it has the cameras' frames
};

RecorderOptions Lossless(RecorderOptions options = {}) {
    options.intake.lossless = true;
    options.intake.live = false;
    return options;
}

/// Numbers of a channel's pictures in the order of the log, each compared byte for byte.
std::vector<std::uint32_t> Pictures(const std::vector<tests::EventInFile>& events,
                                    const std::string& channel, std::uint32_t camera,
                                    std::uint32_t every = 1) {
    std::vector<std::uint32_t> numbers;
    for (const auto& event : events) {
        if (event.channel != channel) continue;
        const auto image = drivers::ParseLoggedImage(event.data);
        EXPECT_TRUE(image);
        numbers.push_back(image.value().sequence.value());
        std::vector<std::uint8_t> expected(hal::FrameBytes(kFormat));
        tests::FillPattern(camera, numbers.back() * every, expected);
        EXPECT_TRUE(std::ranges::equal(image.value().data, expected));
        EXPECT_EQ(image.value().range, hal::Range::kLimited);
        EXPECT_EQ(image.value().captured_at, kPeriod * numbers.back() * every);
        EXPECT_EQ(event.utime_us, kEpoch_us + 100'000 * numbers.back() * every);
    }
    return numbers;
}

std::vector<std::uint32_t> UpTo(std::uint32_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

TEST(RecorderTest, TheFramesOfEveryCameraAreInTheLogBitForBit) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless());
    drive.recorder->Start({});
    drive.Run(300);
    drive.recorder->Finish();
    const auto events = tests::RecordedEvents(folder.path());
    std::uint32_t camera = 0;
    for (const char* channel : {"CAM_FRONT", "CAM_LEFT", "CAM_RIGHT"})
        EXPECT_EQ(Pictures(events, channel, camera++), UpTo(300)) << channel;
    const RecordingSummary summary = drive.recorder->Summarise();
    EXPECT_EQ(summary.dropped, 0U);
    EXPECT_EQ(summary.written.events, events.size());
    for (const FrameCounts& counts : summary.cameras) EXPECT_EQ(counts.recorded, 300U);
}

TEST(RecorderTest, NothingIsRecordedBeforeTheStart) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless());
    drive.Run(3);
    drive.recorder->Finish();
    EXPECT_TRUE(tests::Segments(folder.path()).empty());
}

TEST(RecorderTest, EverySegmentBeginsWithTheRigAndLastsAsLongAsItMay) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless({.segment = seconds(2)}));
    drive.recorder->Start({});
    drive.Run(90);
    drive.recorder->Finish();
    const auto events = tests::RecordedEvents(folder.path());
    EXPECT_EQ(tests::Segments(folder.path()).size(), 5U);
    std::map<std::string, std::int64_t> begun;
    for (const auto& event : events) {
        const bool first = begun.try_emplace(event.file, event.utime_us).second;
        ASSERT_EQ(event.channel == "RIG", first);
        // Cameras may be some frames apart.
        ASSERT_LE(event.utime_us - begun.at(event.file), 2'600'000);
        if (!first) continue;
        const auto rig = drivers::ParseLoggedRig(event.data);
        ASSERT_TRUE(rig);
        EXPECT_EQ(rig.value().rig_yaml, "schema: 1\n");
        EXPECT_EQ(rig.value().cameras.size(), 3U);
        EXPECT_EQ(rig.value().camera_channels[1], "CAM_LEFT");
        EXPECT_EQ(rig.value().utime_us, event.utime_us);
    }
}

TEST(RecorderTest, BothClocksAreLoggedOnceASecondOfTheDrive) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless());
    drive.recorder->Start({});
    drive.Run(50);
    drive.recorder->Finish();
    std::vector<std::int64_t> times;
    for (const auto& event : tests::RecordedEvents(folder.path())) {
        if (event.channel != "CLOCK") continue;
        const auto clock = drivers::ParseLoggedClock(event.data);
        ASSERT_TRUE(clock);
        EXPECT_EQ(clock.value().utime_us - kEpoch_us, clock.value().monotonic.count() / 1000);
        times.push_back(clock.value().utime_us - kEpoch_us);
    }
    ASSERT_EQ(times.size(), 5U);
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GE(times[i] - times[i - 1], 1'000'000);
}

TEST(RecorderTest, OfEachThirdFrameTheNumbersStepByOne) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless({.frames = {.every = 3}}));
    drive.recorder->Start({});
    drive.Run(30);
    drive.recorder->Finish();
    EXPECT_EQ(Pictures(tests::RecordedEvents(folder.path()), "CAM_LEFT", 1, 3), UpTo(10));
}

TEST(RecorderTest, CanFramesAndMessagesAreInTheLogOnTheClockOfTheDrive) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless());
    drive.recorder->Start(seconds(5));
    hal::CanFrame frame{.id = 0x123, .size_bytes = 2, .received_at = seconds(1)};
    frame.data[1] = 9;
    drive.recorder->intake().Put(frame, seconds(5));
    const std::array<std::uint8_t, 3> bytes{1, 2, 3};
    drive.recorder->intake().Put(
        {.channel = "STATUS", .utime_us = kEpoch_us + 6'000'000, .bytes = bytes});
    drive.recorder->Finish();
    const auto events = tests::RecordedEvents(folder.path());
    ASSERT_EQ(events.size(), 4U);  // RIG, CLOCK
    const auto can = drivers::ParseLoggedCanFrame(events[2].data);
    ASSERT_TRUE(can);
    EXPECT_EQ(can.value().bus, "can0");
    EXPECT_EQ(can.value().frame.id, 0x123U);
    EXPECT_EQ(can.value().frame.data[1], 9);
    EXPECT_EQ(can.value().frame.received_at, seconds(6));
    EXPECT_EQ(events[2].utime_us, kEpoch_us + 6'000'000);
    EXPECT_EQ(events[3].channel, "STATUS");
    EXPECT_EQ(events[3].data.size(), 3U);
}

/// Everything of the last seconds before the trigger is there, in order, and what follows.
TEST(RecorderTest, ATriggerBringsTheSecondsBeforeIt) {
    const tests::TemporaryFolder folder;
    std::atomic<bool> trigger{false};
    Drive drive(folder.path(), Lossless({.pre_trigger = seconds(3), .trigger = &trigger}));
    drive.recorder->Start({});
    drive.Run(100);  // until 9.9 s
    while (drive.recorder->Summarise().cameras[0].recorded < 100) std::this_thread::yield();
    while (drive.recorder->Summarise().cameras[2].recorded < 100) std::this_thread::yield();
    EXPECT_EQ(drive.recorder->Level().state, hal::RecordingState::kArmed);
    EXPECT_TRUE(tests::Segments(folder.path()).empty());
    trigger = true;
    while (drive.recorder->Level().state != hal::RecordingState::kOn) std::this_thread::yield();
    drive.Run(20);
    drive.recorder->Finish();
    const auto events = tests::RecordedEvents(folder.path());
    const auto numbers = Pictures(events, "CAM_LEFT", 1);
    ASSERT_FALSE(numbers.empty());
    EXPECT_LE(numbers.front(), 69U + 1);
    EXPECT_GE(numbers.front(), 60U);  // frames of others in between keep some that are older
    EXPECT_EQ(numbers.back(), 119U);
    EXPECT_EQ(numbers.size(), 120 - numbers.front());
}

TEST(RecorderTest, WithoutATriggerNothingIsWritten) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless({.pre_trigger = seconds(3)}));
    drive.recorder->Start({});
    drive.Run(100);
    drive.recorder->Finish();
    EXPECT_TRUE(tests::Segments(folder.path()).empty());
    EXPECT_TRUE(drive.Events().empty());
}

TEST(RecorderTest, WhatMemoryCannotKeepIsTheOldest) {
    const tests::TemporaryFolder folder;
    RecorderOptions options = Lossless({.pre_trigger = seconds(600)});
    options.intake.memory_bytes = 256 << 10;  // some 55 frames of 4 KiB and their heads
    Drive drive(folder.path(), options);
    drive.recorder->Start({});
    drive.Run(200);
    for (std::size_t i = 0; i < 3; ++i)
        while (drive.recorder->Summarise().cameras[i].recorded < 200) std::this_thread::yield();
    drive.recorder->Trigger();
    while (drive.recorder->Level().state != hal::RecordingState::kOn) std::this_thread::yield();
    drive.recorder->Finish();
    const auto events = tests::RecordedEvents(folder.path());
    std::size_t kept = 0;
    std::uint32_t camera = 0;
    for (const char* channel : {"CAM_FRONT", "CAM_LEFT", "CAM_RIGHT"}) {
        const auto numbers = Pictures(events, channel, camera++);
        ASSERT_FALSE(numbers.empty());
        EXPECT_EQ(numbers.back(), 199U);
        EXPECT_EQ(numbers.size(), 200 - numbers.front());
        kept += numbers.size();
    }
    EXPECT_GT(kept, 50U);
    EXPECT_LT(kept, 64U);
    EXPECT_EQ(drive.recorder->Summarise().dropped, 0U);
}

TEST(RecorderTest, AfterATriggerItEndsAndIsArmedAgain) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless({.pre_trigger = seconds(1), .after_trigger = seconds(2)}));
    drive.recorder->Start({});
    for (int round = 0; round < 2; ++round) {
        drive.Run(30);
        for (std::size_t i = 0; i < 3; ++i)
            while (drive.recorder->Summarise().cameras[i].recorded < 60U * round + 30)
                std::this_thread::yield();
        drive.recorder->Trigger();
        while (drive.recorder->Level().state != hal::RecordingState::kOn) std::this_thread::yield();
        drive.Run(30);
        while (drive.recorder->Level().state != hal::RecordingState::kArmed)
            std::this_thread::yield();
    }
    drive.recorder->Finish();
    const auto events = drive.Events();
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events[0].code, hal::EventCode::kRecordingStarted);
    EXPECT_EQ(events[1].code, hal::EventCode::kRecordingStopped);
    EXPECT_EQ(tests::Segments(folder.path()).size(), 2U);
}

struct CameraTriggerCase {
    RecordConfig::Trigger by;
    hal::EventCode code;
    bool triggers;
};

TEST(RecorderTest, AFaultyCameraTriggersWhereItShould) {
    using By = RecordConfig::Trigger;
    using hal::EventCode;
    for (const auto& [by, code, triggers] :
         {CameraTriggerCase{By::kSignal, EventCode::kCameraLost, false},
          CameraTriggerCase{By::kCameraLost, EventCode::kCameraLost, true},
          CameraTriggerCase{By::kCameraLost, EventCode::kCameraFrozen, false},
          CameraTriggerCase{By::kCameraFault, EventCode::kCameraLost, true},
          CameraTriggerCase{By::kCameraFault, EventCode::kCameraDirty, true},
          CameraTriggerCase{By::kCameraFault, EventCode::kSeamCoast, false}}) {
        const tests::TemporaryFolder folder;
        Drive drive(folder.path(), Lossless({.pre_trigger = seconds(9), .trigger_by = by}));
        drive.recorder->Start({});
        drive.Run(5);
        drive.recorder->Note({.code = hal::EventCode::kCameraBack});
        std::this_thread::sleep_for(milliseconds(120));
        EXPECT_EQ(drive.recorder->Level().state, hal::RecordingState::kArmed);
        drive.recorder->Note({.code = code});
        while (triggers && drive.recorder->Level().state != hal::RecordingState::kOn)
            std::this_thread::yield();
        drive.recorder->Finish();
        EXPECT_EQ(tests::Segments(folder.path()).size(), triggers ? 1U : 0U);
    }
}

TEST(RecorderTest, BelowTheFloorOfFreeSpaceItSaysSoOnceAndNobodyWaits) {
    const tests::TemporaryFolder folder;
    Drive drive(folder.path(), Lossless({.folder = {.min_free_bytes = 1ULL << 60}}));
    drive.recorder->Start({});
    for (int i = 0; i < 50; ++i) {
        drive.Run(10);
        drive.clock.Advance(seconds(1));
    }
    drive.recorder->Finish();
    const auto events = drive.Events();
    ASSERT_GE(events.size(), 1U);
    EXPECT_EQ(events[0].code, hal::EventCode::kRecordingFailed);
    EXPECT_NE(events[0].text.view().find("MB free, must stay"), std::string::npos)
        << events[0].text.view();
    for (std::size_t i = 1; i < events.size(); ++i)
        EXPECT_EQ(events[i].code, hal::EventCode::kRecordingDropped);
    EXPECT_GT(drive.recorder->Level().dropped, 0U);
    EXPECT_EQ(drive.recorder->Level().state, hal::RecordingState::kStopped);
    EXPECT_TRUE(tests::Segments(folder.path()).empty());
}

TEST(RecorderTest, AQuotaHoldsAtEveryMoment) {
    const tests::TemporaryFolder folder;
    constexpr std::uint64_t kQuota = 400'000;
    const auto recorded_bytes = [&] {
        std::uint64_t bytes = 0;
        std::error_code gone;
        for (const auto& file : tests::Segments(folder.path())) {
            const auto size = std::filesystem::file_size(file, gone);
            bytes += gone ? 0 : size;
        }
        return bytes;
    };
    RecorderOptions options =
        Lossless({.folder = {.quota_bytes = kQuota}, .segment = seconds(3600)});
    options.intake.memory_bytes = 128 << 10;  // so that the cameras wait for the disk
    Drive drive(folder.path(), options);
    drive.recorder->Start({});
    std::uint64_t most = 0;
    for (int i = 0; i < 40; ++i) {
        drive.Run(10);
        most = std::max(most, recorded_bytes());
    }
    drive.recorder->Finish();
    EXPECT_LE(most, kQuota + 2 * hal::FrameBytes(kFormat));
    EXPECT_LE(recorded_bytes(), kQuota);
    EXPECT_GT(recorded_bytes(), kQuota / 2);
    EXPECT_GT(drive.recorder->Summarise().written.bytes, 3 * kQuota);
    const auto numbers = Pictures(tests::RecordedEvents(folder.path()), "CAM_FRONT", 0);
    EXPECT_EQ(numbers.back(), 399U);
}

TEST(RecorderTest, RawFramesThatMemoryCannotHoldAreRefusedAtTheStart) {
    const tests::TemporaryFolder folder;
    hal::FakeClock clock;
    EventQueue events;
    FrameTap tap;
    RecorderOptions options{.folder = {.folder = folder.path()}, .frames = {.raw = true}};
    options.intake.memory_bytes = 8 << 20;
    const auto refused = Recorder::Open(
        options, {},
        {{"front", "CAM_FRONT", {4096, 2160, hal::PixelFormat::kUyvy, hal::Range::kFull}, &tap}},
        clock, events);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error(), "record.memory_mb is 8, must be at least 68 for these raw frames");
}

/// A process that is killed at some moment leaves whole events, and the numbers have no gap.
TEST(RecorderTest, AKilledProgramLeavesAReadableLog) {
    for (int round = 0; round < 12; ++round) {
        const tests::TemporaryFolder folder;
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            Drive drive(folder.path(), Lossless({.segment = seconds(3)}));
            drive.recorder->Start({});
            while (true) drive.Run(1);
        }
        std::this_thread::sleep_for(milliseconds(5 + 13 * round));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        if (tests::Segments(folder.path()).empty()) continue;
        const auto events = tests::RecordedEvents(folder.path(), true);
        const auto numbers = Pictures(events, "CAM_RIGHT", 2);
        EXPECT_EQ(numbers, UpTo(static_cast<std::uint32_t>(numbers.size())));
    }
}

}  // namespace
}  // namespace hitchview::app
