#include <gtest/gtest.h>

#include <vector>

#include "app/deadline_events.hpp"
#include "app/seam_events.hpp"

namespace hitchview::app {
namespace {

using hal::Event;
using hal::EventCode;
using hal::Instant;
using hal::SeamState;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kPeriod{33};

TEST(SeamEventsTest, ThePlaceWhereItBeginsIsNoEvent) {
    SeamEvents seam("left");
    EXPECT_FALSE(seam.Note(SeamState::kLocked, 40, milliseconds(0)));
    EXPECT_FALSE(seam.Note(SeamState::kLocked, 41, milliseconds(33)));
}

TEST(SeamEventsTest, EachStateHasItsCode) {
    const std::pair<SeamState, EventCode> states[] = {
        {SeamState::kReacquire, EventCode::kSeamReacquire},
        {SeamState::kLocked, EventCode::kSeamLocked},
        {SeamState::kCoast, EventCode::kSeamCoast},
        {SeamState::kNoOverlap, EventCode::kSeamNoOverlap}};
    SeamEvents seam("right");
    Instant now{};
    seam.Note(SeamState::kNoOverlap, 0, now);
    for (const auto& [state, code] : states) {
        now += seconds(5);
        const auto event = seam.Note(state, 12, now);
        ASSERT_TRUE(event) << ToString(code);
        EXPECT_EQ(event->code, code);
        EXPECT_EQ(event->when, now);
        EXPECT_EQ(event->subject.view(), "right");
    }
}

TEST(SeamEventsTest, ASeamThatFlickersTellsAtMostOnceASecond) {
    SeamEvents seam("left");
    std::vector<Instant> told;
    seam.Note(SeamState::kLocked, 40, milliseconds(0));
    for (int i = 1; i <= 300; ++i) {
        const auto event =
            seam.Note(i % 2 == 0 ? SeamState::kLocked : SeamState::kCoast, 5, i * kPeriod);
        if (event) told.push_back(event->when);
    }
    EXPECT_GE(told.size(), 5U);
    EXPECT_LE(told.size(), 10U);  // in 9.9 s
    for (std::size_t i = 1; i < told.size(); ++i) EXPECT_GE(told[i] - told[i - 1], seconds(1));
}

TEST(SeamEventsTest, TheStateAtRestIsToldInTheEnd) {
    SeamEvents seam("left");
    seam.Note(SeamState::kLocked, 40, milliseconds(0));
    ASSERT_TRUE(seam.Note(SeamState::kCoast, 5, milliseconds(100)));
    EXPECT_FALSE(seam.Note(SeamState::kNoOverlap, 0, milliseconds(200)));
    EXPECT_FALSE(seam.Note(SeamState::kNoOverlap, 0, milliseconds(1099)));
    const auto event = seam.Note(SeamState::kNoOverlap, 0, milliseconds(1100));
    ASSERT_TRUE(event);
    EXPECT_EQ(event->code, EventCode::kSeamNoOverlap);
}

/// All events of `misses`, one count each period and then silence for ten seconds.
std::vector<Event> EventsOf(const std::vector<std::uint64_t>& misses) {
    DeadlineEvents deadlines(kPeriod);
    std::vector<Event> events;
    for (int i = 0; i < static_cast<int>(misses.size()) + 300; ++i) {
        const std::size_t place =
            std::min<std::size_t>(static_cast<std::size_t>(i), misses.size() - 1);
        if (const auto event = deadlines.Note(misses[place], i * kPeriod)) events.push_back(*event);
    }
    return events;
}

TEST(DeadlineEventsTest, WithoutAMissNothingIsTold) {
    EXPECT_TRUE(EventsOf({0, 0, 0}).empty());
}

TEST(DeadlineEventsTest, AnEpisodeIsTwoEventsHoweverManyAreLate) {
    std::vector<std::uint64_t> misses{0, 0};
    for (std::uint64_t i = 1; i <= 90; ++i) misses.push_back(i);  // three seconds, each late
    const auto events = EventsOf(misses);
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(events[0].code, EventCode::kDeadlineMissed);
    EXPECT_EQ(events[0].when, 2 * kPeriod);
    EXPECT_EQ(events[0].text.view(), "a panorama took longer than the period of 33 ms");
    EXPECT_EQ(events[1].code, EventCode::kDeadlineKept);
    EXPECT_EQ(events[1].text.view(), "in time again: 90 were late within 2937 ms");
    EXPECT_GE(events[1].when - 91 * kPeriod, DeadlineEvents::kCalm);
}

TEST(DeadlineEventsTest, EpisodesThatLieApartAreToldApart) {
    std::vector<std::uint64_t> misses{0, 1};
    misses.resize(100, 1);
    misses.resize(101, 4);
    const auto events = EventsOf(misses);
    ASSERT_EQ(events.size(), 4U);
    EXPECT_EQ(events[1].text.view(), "in time again: 1 were late within 0 ms");
    EXPECT_EQ(events[3].text.view(), "in time again: 3 were late within 0 ms");
}

TEST(DropEventsTest, TellsTheBeginningAndThenOnceInTenSeconds) {
    DropEvents drops;
    EXPECT_FALSE(drops.Note(0, seconds(1)));
    const auto first = drops.Note(2, seconds(2));
    ASSERT_TRUE(first);
    EXPECT_EQ(first->code, EventCode::kPanoramasDropped);
    EXPECT_TRUE(first->text.view().starts_with("2 frame sets were left out"));
    EXPECT_FALSE(drops.Note(9, seconds(5)));
    const auto second = drops.Note(12, seconds(12));
    ASSERT_TRUE(second);
    EXPECT_TRUE(second->text.view().starts_with("10 frame sets"));
    EXPECT_FALSE(drops.Note(12, seconds(100)));
}

}  // namespace
}  // namespace hitchview::app
