#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "app/first_sets.hpp"

namespace hitchview::app {
namespace {

/// Sets that lack the cameras of a script, numbered, then the end.
class ScriptedSets final : public FrameSynchronizer {
 public:
    explicit ScriptedSets(std::deque<std::uint32_t> missing) : missing_(std::move(missing)) {}

 private:
    hal::Result<FrameSet> DoWaitSet() override {
        if (missing_.empty()) return hal::Error::kEndOfStream;
        FrameSet set;
        set.sequence = next_++;
        set.cameras_missing = missing_.front();
        missing_.pop_front();
        return set;
    }

    std::deque<std::uint32_t> missing_;
    std::uint32_t next_ = 0;
};

class FirstSetsTest : public testing::Test {
 protected:
    /// Numbers of the sets that were looked at; `enough`: the last one.
    std::vector<std::uint32_t> LookedAt(std::deque<std::uint32_t> missing, int patience,
                                        std::uint32_t enough = 1000, std::uint32_t awaited = 0) {
        std::vector<std::uint32_t> seen;
        ScriptedSets sets(std::move(missing));
        outcome_ = ShowFirstSets(
            sets, {.sets = patience, .cameras_awaited = awaited},
            [&](const FrameSet& set) {
                seen.push_back(set.sequence);
                return set.sequence == enough;
            },
            stop_);
        return seen;
    }

    std::atomic<bool> stop_{false};
    hal::Result<hal::Done> outcome_ = hal::Done{};
};

using Numbers = std::vector<std::uint32_t>;

TEST_F(FirstSetsTest, EndsWhenEnoughWasSeenOrAfterTenSets) {
    EXPECT_EQ(LookedAt(std::deque<std::uint32_t>(99, 0), 0, 2), (Numbers{0, 1, 2}));
    EXPECT_EQ(LookedAt(std::deque<std::uint32_t>(99, 0), 0).size(), std::size_t{kFirstSets});
}

TEST_F(FirstSetsTest, CamerasThatAreKnownToBeAbsentAreNot) {
    EXPECT_EQ(LookedAt(std::deque<std::uint32_t>(50, 0b100), 40, 2, 0b100), (Numbers{0, 1, 2}));
    EXPECT_EQ(LookedAt({0b110, 0b110, 0b100}, 40, 2, 0b100), (Numbers{2})) << "camera 1 is late";
}

TEST_F(FirstSetsTest, CamerasThatStartLateAreWaitedFor) {
    std::deque<std::uint32_t> missing(30, 0b11);
    missing.insert(missing.end(), 20, 0);
    EXPECT_EQ(LookedAt(missing, 90, 30), Numbers{30});
}

TEST_F(FirstSetsTest, ACameraThatNeverStartsIsNotWaitedForForEver) {
    EXPECT_EQ(LookedAt(std::deque<std::uint32_t>(99, 0b1), 20, 21), (Numbers{20, 21}));
}

TEST_F(FirstSetsTest, AfterTheFirstWholeSetNothingIsPassedOver) {
    EXPECT_EQ(LookedAt({0b1, 0, 0b1, 0}, 90), (Numbers{1, 2, 3}));
}

TEST_F(FirstSetsTest, OnlyARecordingWithoutAnySetIsAnError) {
    LookedAt({0}, 0);
    EXPECT_TRUE(outcome_.ok());
    LookedAt({}, 0);
    EXPECT_FALSE(outcome_.ok());
}

TEST_F(FirstSetsTest, EndsWhenStopped) {
    stop_ = true;
    EXPECT_TRUE(LookedAt({0, 0}, 0).empty());
    EXPECT_TRUE(outcome_.ok());
}

}  // namespace
}  // namespace hitchview::app
