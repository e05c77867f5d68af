#include <gtest/gtest.h>

#include <random>

#include "algo/seam_hysteresis.hpp"

namespace hitchview::algo {
namespace {

using Seen = SeamHysteresis::Seen;

constexpr Seen kMatched{.matched = true, .placed = true, .shared = true};
constexpr Seen kUnmatched{.matched = false, .placed = true, .shared = true};
constexpr Seen kApart{.matched = false, .placed = true, .shared = false};
constexpr Seen kNotFound{.matched = false, .placed = false, .shared = true};

class SeamHysteresisTest : public testing::Test {
 protected:
    SeamState After(int frames, const Seen& seen) {
        for (int i = 0; i < frames; ++i) sut_.Update(seen);
        return sut_.state();
    }

    SeamHysteresis sut_;
};

TEST_F(SeamHysteresisTest, NothingIsSharedBeforeTheFirstFrame) {
    EXPECT_EQ(sut_.state(), SeamState::kNoOverlap);
    EXPECT_TRUE(sut_.LongUnmatched());
}

TEST_F(SeamHysteresisTest, TheFirstMatchLocks) {
    EXPECT_EQ(sut_.Update(kMatched), SeamState::kLocked);
    EXPECT_FALSE(sut_.LongUnmatched());
}

TEST_F(SeamHysteresisTest, WhatIsNotMatchedIsNotSaidToBeLockedForOneFrame) {
    sut_.Update(kMatched);
    EXPECT_EQ(sut_.Update(kUnmatched), SeamState::kCoast);
    sut_.Reset();
    sut_.Update(kMatched);
    EXPECT_EQ(sut_.Update(kApart), SeamState::kNoOverlap);
}

TEST_F(SeamHysteresisTest, CoastsForSixtyFramesThenSearches) {
    sut_.Update(kMatched);
    EXPECT_EQ(After(SeamHysteresis::kCoast - 1, kUnmatched), SeamState::kCoast);
    EXPECT_FALSE(sut_.LongUnmatched());
    EXPECT_EQ(sut_.Update(kUnmatched), SeamState::kReacquire);
    EXPECT_TRUE(sut_.LongUnmatched());
}

TEST_F(SeamHysteresisTest, WhatIsFoundAgainLocksAtOnce) {
    sut_.Update(kMatched);
    ASSERT_EQ(After(SeamHysteresis::kCoast, kUnmatched), SeamState::kReacquire);
    EXPECT_EQ(sut_.Update(kMatched), SeamState::kLocked);
    ASSERT_EQ(After(100, kApart), SeamState::kNoOverlap);
    EXPECT_EQ(sut_.Update(kMatched), SeamState::kLocked);
}

TEST_F(SeamHysteresisTest, WhereMatchesComeAndGoItCoasts) {
    sut_.Update(kMatched);
    ASSERT_EQ(sut_.Update(kUnmatched), SeamState::kCoast);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(After(SeamHysteresis::kHold - 1, kMatched), SeamState::kCoast) << i;
        EXPECT_EQ(sut_.Update(kUnmatched), SeamState::kCoast) << i;
    }
}

TEST_F(SeamHysteresisTest, LocksAnewAfterFiveMatchedFrames) {
    sut_.Update(kMatched);
    ASSERT_EQ(sut_.Update(kUnmatched), SeamState::kCoast);
    for (int i = 1; i < SeamHysteresis::kHold; ++i)
        EXPECT_EQ(sut_.Update(kMatched), SeamState::kCoast) << i;
    EXPECT_EQ(sut_.Update(kMatched), SeamState::kLocked);
}

TEST_F(SeamHysteresisTest, BetweenCoastAndNoOverlapLieFiveFrames) {
    sut_.Update(kMatched);
    ASSERT_EQ(sut_.Update(kUnmatched), SeamState::kCoast);
    for (int i = 1; i < SeamHysteresis::kHold; ++i)
        EXPECT_EQ(sut_.Update(kApart), SeamState::kCoast) << i;
    EXPECT_EQ(sut_.Update(kApart), SeamState::kNoOverlap);
    EXPECT_EQ(After(SeamHysteresis::kHold - 1, kUnmatched), SeamState::kNoOverlap);
    EXPECT_EQ(sut_.Update(kUnmatched), SeamState::kCoast);
}

TEST_F(SeamHysteresisTest, SearchesNoMoreWhereNothingIsShared) {
    sut_.Update(kMatched);
    ASSERT_EQ(After(SeamHysteresis::kCoast + SeamHysteresis::kHold, kUnmatched),
              SeamState::kReacquire);
    EXPECT_EQ(sut_.Update(kApart), SeamState::kNoOverlap);
    EXPECT_EQ(After(SeamHysteresis::kHold, kUnmatched), SeamState::kReacquire);
}

TEST_F(SeamHysteresisTest, ATrailerThatWasNotFoundHasNoOverlap) {
    EXPECT_EQ(After(3, kNotFound), SeamState::kNoOverlap);
}

TEST_F(SeamHysteresisTest, AfterAResetTheFirstMatchLocksAgain) {
    sut_.Update(kMatched);
    sut_.Update(kUnmatched);
    sut_.Reset();
    EXPECT_EQ(sut_.state(), SeamState::kNoOverlap);
    EXPECT_TRUE(sut_.LongUnmatched());
    EXPECT_EQ(sut_.Update(kMatched), SeamState::kLocked);
}

// Whatever comes: kHold frames from one entry of LOCKED to the next, and between changes of other
// states.
TEST_F(SeamHysteresisTest, NothingFlickersWhateverComes) {
    std::mt19937 random(5);
    const Seen inputs[]{kMatched, kUnmatched, kApart, kNotFound};
    int last_lock = -100;
    int last_other = -100;
    int changes = 0;
    SeamState state = sut_.state();
    for (int frame = 0; frame < 20000; ++frame) {
        const SeamState late = sut_.Update(inputs[random() % 4]);
        if (late == state) continue;
        ++changes;
        if (late == SeamState::kLocked) {
            EXPECT_GT(frame - last_lock, SeamHysteresis::kHold);
            last_lock = frame;
        } else if (state != SeamState::kLocked) {
            EXPECT_GE(frame - last_other, SeamHysteresis::kHold);
        }
        last_other = frame;
        state = late;
    }
    EXPECT_GT(changes, 1000);
}

TEST_F(SeamHysteresisTest, LockedIsOnlyWhatMatchedInThisFrame) {
    std::mt19937 random(6);
    for (int frame = 0; frame < 5000; ++frame) {
        const bool matched = random() % 3 != 0;
        const SeamState state = sut_.Update(matched ? kMatched : kUnmatched);
        EXPECT_TRUE(matched || state != SeamState::kLocked);
    }
}

}  // namespace
}  // namespace hitchview::algo
