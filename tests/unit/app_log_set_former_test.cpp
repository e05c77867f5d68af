#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "app/log_set_former.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using std::chrono::milliseconds;

constexpr Instant kPeriod = milliseconds(40);
constexpr std::size_t kCameras = 4;

LoggedFrame Frame(std::size_t camera, std::uint32_t number, Instant phase = {}) {
    return {.camera = camera,
            .header = {.sequence = number, .captured_at = number * kPeriod + phase}};
}

/// Frames of all cameras, set by set; camera i is i milliseconds late.
std::vector<LoggedFrame> Drive(std::uint32_t frames) {
    std::vector<LoggedFrame> drive;
    for (std::uint32_t number = 0; number < frames; ++number) {
        for (std::size_t camera = 0; camera < kCameras; ++camera)
            drive.push_back(Frame(camera, number, milliseconds(camera)));
    }
    return drive;
}

void Drop(std::size_t camera, std::uint32_t first, std::uint32_t end,
          std::vector<LoggedFrame>& drive) {
    std::erase_if(drive, [&](const LoggedFrame& f) {
        return f.camera == camera && f.header.sequence >= first && f.header.sequence < end;
    });
}

std::vector<LoggedSet> SetsOf(const std::vector<LoggedFrame>& drive) {
    LogSetFormer former(kCameras, kPeriod, kPeriod);
    std::vector<LoggedSet> sets;
    const auto take = [&] {
        while (const auto set = former.Take()) sets.push_back(*set);
    };
    for (const LoggedFrame& frame : drive) {
        former.Add(frame);
        take();
    }
    former.Finish();
    take();
    return sets;
}

/// Numbers of the cameras' frames in a set; -1 for a missing one.
std::vector<int> Numbers(const LoggedSet& set) {
    std::vector<int> numbers;
    for (std::size_t i = 0; i < kCameras; ++i)
        numbers.push_back(set.frames[i] ? static_cast<int>(set.frames[i]->header.sequence) : -1);
    return numbers;
}

std::vector<std::vector<int>> AllNumbers(const std::vector<LoggedFrame>& drive) {
    std::vector<std::vector<int>> numbers;
    for (const LoggedSet& set : SetsOf(drive)) numbers.push_back(Numbers(set));
    return numbers;
}

TEST(LogSetFormerTest, EverySetOfAWholeRecordingIsComplete) {
    const auto sets = SetsOf(Drive(50));
    ASSERT_EQ(sets.size(), 50U);
    for (std::uint32_t i = 0; i < 50; ++i) {
        EXPECT_EQ(sets[i].sequence, i);
        EXPECT_EQ(Numbers(sets[i]), std::vector<int>(kCameras, static_cast<int>(i)));
    }
}

TEST(LogSetFormerTest, TheOrderInWhichCamerasWereWrittenDoesNotMatter) {
    auto drive = Drive(100);
    Drop(1, 20, 45, drive);
    Drop(3, 77, 78, drive);
    const auto expected = AllNumbers(drive);
    std::mt19937 random(1);
    for (int i = 0; i < 20; ++i) {
        // Each frame comes up to 400 ms late, so those of a camera out of order, too.
        std::vector<std::pair<Instant, LoggedFrame>> late;
        for (const LoggedFrame& frame : drive)
            late.emplace_back(frame.header.captured_at + milliseconds(random() % 400), frame);
        std::ranges::stable_sort(late, {}, &std::pair<Instant, LoggedFrame>::first);
        std::vector<LoggedFrame> shuffled;
        for (const auto& [at, frame] : late) shuffled.push_back(frame);
        EXPECT_EQ(AllNumbers(shuffled), expected);
    }
}

TEST(LogSetFormerTest, ACameraIsMissingExactlyWhereItHasNoFrame) {
    auto drive = Drive(60);
    Drop(0, 10, 30, drive);
    Drop(3, 40, 41, drive);
    const auto numbers = AllNumbers(drive);
    ASSERT_EQ(numbers.size(), 60U);
    for (int i = 0; i < 60; ++i) {
        const int first = i >= 10 && i < 30 ? -1 : i;
        const int last = i == 40 ? -1 : i;
        EXPECT_THAT(numbers[static_cast<std::size_t>(i)], testing::ElementsAre(first, i, i, last));
    }
}

TEST(LogSetFormerTest, PeriodsWithoutAnyFrameAreAGapOfTheNumbers) {
    auto drive = Drive(30);
    for (std::size_t camera = 0; camera < kCameras; ++camera) Drop(camera, 10, 15, drive);
    const auto sets = SetsOf(drive);
    ASSERT_EQ(sets.size(), 25U);
    EXPECT_EQ(sets[9].sequence, 9U);
    EXPECT_EQ(sets[10].sequence, 15U);
}

TEST(LogSetFormerTest, AFrameThatIsInTheRecordingTwiceIsTakenOnce) {
    std::vector<LoggedFrame> twice;
    for (const LoggedFrame& frame : Drive(20)) twice.insert(twice.end(), {frame, frame});
    EXPECT_EQ(AllNumbers(twice), AllNumbers(Drive(20)));
}

TEST(LogSetFormerTest, ACameraFarAheadOfTheOthersIsNotWaitedForWithoutEnd) {
    // One camera's frames first, all of them: more than are kept.
    auto drive = Drive(1000);
    std::ranges::stable_partition(drive, [](const LoggedFrame& f) { return f.camera == 2; });
    const auto sets = SetsOf(drive);
    EXPECT_GE(sets.size(), 1000U);
    std::size_t frames = 0;
    for (const LoggedSet& set : sets)
        frames += static_cast<std::size_t>(
            std::ranges::count_if(set.frames, [](const auto& frame) { return frame.has_value(); }));
    EXPECT_GE(frames, 1000U);
}

TEST(LogSetFormerTest, CamerasThatRunAtTheirOwnPhasesMakeTheTightestSets) {
    // Camera 3 is 35 ms late: its frame goes better with those of the next period.
    std::vector<LoggedFrame> drive;
    for (std::uint32_t number = 0; number < 40; ++number) {
        for (std::size_t camera = 0; camera < kCameras; ++camera)
            drive.push_back(Frame(camera, number, camera == 3 ? milliseconds(35) : Instant{}));
    }
    const auto numbers = AllNumbers(drive);
    ASSERT_GE(numbers.size(), 40U);
    for (std::size_t i = 2; i < 39; ++i) EXPECT_EQ(numbers[i][3], numbers[i][0] - 1) << "set " << i;
}

}  // namespace
}  // namespace hitchview::app
