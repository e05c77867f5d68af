#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include "drivers/frame_accounting.hpp"
#include "drivers/v4l2_stamps.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;

constexpr hal::Instant kPeriod = milliseconds(40);

class FrameAccountingTest : public testing::Test {
 protected:
    /// Frame `sequence` with its stamp in milliseconds; the sequence given out, -1 if corrupted.
    std::int64_t Accept(std::uint32_t sequence, int stamp_ms, bool damaged = false) {
        const auto header = accounting_.Accept(sequence, milliseconds(stamp_ms), damaged);
        return header ? static_cast<std::int64_t>(header.value().sequence) : -1;
    }

    FrameAccounting accounting_{kPeriod};
};

TEST_F(FrameAccountingTest, FramesInOrderLackNothing) {
    for (int i = 0; i < 10; ++i) EXPECT_EQ(Accept(7 + i, 40 * i), i);
    EXPECT_EQ(accounting_.counts().lost, 0U);
    EXPECT_EQ(accounting_.counts().lost_unnumbered, 0U);
}

TEST_F(FrameAccountingTest, AGapInTheSequenceIsLostFramesAndStaysAGap) {
    EXPECT_EQ(Accept(100, 0), 0);
    EXPECT_EQ(Accept(104, 160), 4);
    EXPECT_EQ(accounting_.counts().lost, 3U);
    EXPECT_EQ(accounting_.counts().lost_unnumbered, 0U);
}

TEST_F(FrameAccountingTest, TheSequenceMayWrap) {
    EXPECT_EQ(Accept(0xFFFFFFFEU, 0), 0);
    EXPECT_EQ(Accept(0xFFFFFFFFU, 40), 1);
    EXPECT_EQ(Accept(1, 120), 3);
    EXPECT_EQ(accounting_.counts().lost, 1U);
}

TEST_F(FrameAccountingTest, AStepInTimeWithoutAGapIsUnnumberedLoss) {
    Accept(0, 0);
    Accept(1, 60);  // exactly 1.5 periods: late, not lost
    EXPECT_EQ(accounting_.counts().lost_unnumbered, 0U);
    EXPECT_EQ(Accept(2, 181), 2);  // three periods
    EXPECT_EQ(accounting_.counts().lost_unnumbered, 2U);
    EXPECT_EQ(accounting_.counts().lost, 0U);
}

TEST_F(FrameAccountingTest, OfADeviceThatDoesNotNumberTheStampsTell) {
    EXPECT_EQ(Accept(0, 0), 0);
    EXPECT_EQ(Accept(0, 40), 1);
    EXPECT_EQ(Accept(0, 160), 4);
    EXPECT_EQ(accounting_.counts().lost_unnumbered, 2U);
    EXPECT_EQ(accounting_.counts().lost, 0U);
}

TEST_F(FrameAccountingTest, ANumberThatADeviceStaysAtIsGivenOutAgain) {
    EXPECT_EQ(Accept(7, 0), 0);
    EXPECT_EQ(Accept(8, 40), 1);
    for (int stamp_ms = 80; stamp_ms < 400; stamp_ms += 40) EXPECT_EQ(Accept(8, stamp_ms), 1);
    EXPECT_EQ(Accept(9, 400), 2);
    EXPECT_EQ(accounting_.counts().lost + accounting_.counts().lost_unnumbered, 0U);
    accounting_.Restart();
    EXPECT_EQ(Accept(0, 1000), 3);
    EXPECT_EQ(Accept(0, 1040), 4) << "it does not number its frames now";
}

TEST_F(FrameAccountingTest, ADamagedFrameIsCountedAndLeavesNoLoss) {
    Accept(0, 0);
    EXPECT_EQ(Accept(1, 40, true), -1);
    EXPECT_EQ(Accept(2, 80), 2);
    EXPECT_EQ(accounting_.counts().corrupted, 1U);
    EXPECT_EQ(accounting_.counts().lost + accounting_.counts().lost_unnumbered, 0U);
}

TEST_F(FrameAccountingTest, ADamagedFrameNeedsNoStamp) {
    EXPECT_EQ(Accept(0, 0, true), -1);
    Accept(1, 1'000'000);
    EXPECT_EQ(Accept(2, 0, true), -1);
    EXPECT_EQ(Accept(3, 1'000'080), 3);
    EXPECT_EQ(accounting_.counts().corrupted, 2U);
    EXPECT_EQ(accounting_.counts().lost + accounting_.counts().lost_unnumbered, 0U);
}

TEST_F(FrameAccountingTest, AStampThatStepsBackIsRefusedOnce) {
    Accept(0, 1000);
    EXPECT_EQ(Accept(1, 500), -1);
    EXPECT_EQ(Accept(2, 540), 2);
    EXPECT_EQ(accounting_.counts().corrupted, 1U);
    EXPECT_EQ(accounting_.counts().lost_unnumbered, 0U);
}

TEST_F(FrameAccountingTest, AStreamThatStartsAgainGoesOnWithoutAGap) {
    Accept(50, 0);
    accounting_.Restart();
    EXPECT_EQ(Accept(3, 5000), 1);
    EXPECT_EQ(accounting_.counts().lost + accounting_.counts().lost_unnumbered, 0U);
}

TEST(V4l2StampTest, ClockAndSourceStandInTheFlags) {
    constexpr std::uint32_t kMonotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    EXPECT_EQ(StampSourceOf(kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE),
              V4l2StampSource::kStartOfExposure);
    EXPECT_EQ(StampSourceOf(kMonotonic | V4L2_BUF_FLAG_ERROR), V4l2StampSource::kEndOfFrame);
    EXPECT_EQ(StampSourceOf(V4L2_BUF_FLAG_TSTAMP_SRC_SOE), V4l2StampSource::kDequeue);
    EXPECT_EQ(StampSourceOf(V4L2_BUF_FLAG_TIMESTAMP_COPY), V4l2StampSource::kDequeue);
}

TEST(V4l2StampTest, ExposureIsSubtractedFromAnEndAndAtMostAPeriod) {
    const hal::Instant stamp = milliseconds(1000);
    using Source = V4l2StampSource;
    EXPECT_EQ(ExposureStart(stamp, Source::kStartOfExposure, milliseconds(8), kPeriod), stamp);
    EXPECT_EQ(ExposureStart(stamp, Source::kEndOfFrame, milliseconds(8), kPeriod),
              milliseconds(992));
    EXPECT_EQ(ExposureStart(stamp, Source::kEndOfFrame, std::nullopt, kPeriod), milliseconds(960));
    EXPECT_EQ(ExposureStart(stamp, Source::kDequeue, milliseconds(90), kPeriod), milliseconds(960));
}

}  // namespace
}  // namespace hitchview::drivers
