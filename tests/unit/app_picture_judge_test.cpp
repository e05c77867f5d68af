#include <gtest/gtest.h>

#include "app/picture_judge.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// The sender's clock is behind by this much.
constexpr Instant kApart = seconds(1000);
constexpr Instant kOnItsWay = milliseconds(40);

class PictureJudgeTest : public testing::Test {
 protected:
    /// Of a picture that is `late` by more than its usual way.
    PictureVerdict Judge(std::uint32_t sequence, Instant captured, Instant late = {},
                         std::uint32_t missing = 0, std::optional<int> cameras = 8) {
        return judge_.Judge({.sequence = sequence,
                             .captured_from = captured,
                             .captured_until = captured,
                             .cameras_missing = missing},
                            kApart + captured + kOnItsWay + late, cameras);
    }

    PictureJudge judge_;
};

TEST_F(PictureJudgeTest, PicturesThatGoOnAreGoodWhateverTheClocksSay) {
    for (std::uint32_t i = 0; i < 30; ++i)
        EXPECT_EQ(Judge(i, seconds(5) + i * milliseconds(33)), PictureVerdict::kShown) << i;
}

TEST_F(PictureJudgeTest, AGapOfNumbersAndTheirEndAreGoingOn) {
    EXPECT_EQ(Judge(0xFFFFFFFE, seconds(5)), PictureVerdict::kShown);
    EXPECT_EQ(Judge(3, seconds(6)), PictureVerdict::kShown);
}

TEST_F(PictureJudgeTest, ANumberThatCameBeforeIsRepeated) {
    Judge(7, seconds(5));
    EXPECT_EQ(Judge(7, seconds(5), milliseconds(33)), PictureVerdict::kRepeated);
    EXPECT_EQ(Judge(6, seconds(5), milliseconds(66)), PictureVerdict::kRepeated);
    EXPECT_EQ(Judge(7, seconds(6)), PictureVerdict::kShown) << "it goes on from the newest";
}

TEST_F(PictureJudgeTest, APictureCapturedMoreThanASecondAgoIsOld) {
    Judge(1, seconds(5));
    EXPECT_EQ(Judge(2, seconds(6), milliseconds(990)), PictureVerdict::kShown);
    EXPECT_EQ(Judge(3, seconds(7), milliseconds(1010)), PictureVerdict::kOld);
    EXPECT_EQ(Judge(4, seconds(9)), PictureVerdict::kShown);
}

TEST_F(PictureJudgeTest, OneCameraOfAllIsEnough) {
    EXPECT_EQ(Judge(1, seconds(5), {}, 0x7F, 8), PictureVerdict::kShown);
    EXPECT_EQ(Judge(2, seconds(6), {}, 0xFF, 8), PictureVerdict::kNoCamera);
    EXPECT_EQ(Judge(3, seconds(7), {}, 0x01, 1), PictureVerdict::kNoCamera);
}

TEST_F(PictureJudgeTest, WhileTheCamerasAreNotKnownNoneMayBeMissing) {
    EXPECT_EQ(Judge(1, seconds(5), {}, 0, std::nullopt), PictureVerdict::kShown);
    EXPECT_EQ(Judge(2, seconds(6), {}, 0x01, std::nullopt), PictureVerdict::kNoCamera);
}

}  // namespace
}  // namespace hitchview::app
