#include <gtest/gtest.h>

#include "app/frame_inbox.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;

class FrameInboxTest : public testing::Test {
 protected:
    void Put(int stamp_ms) {
        const auto slot = pool_.Take();
        ASSERT_TRUE(slot);
        inbox_.Put(kCamera, pool_.Lease(*slot, {.captured_at = milliseconds(stamp_ms)}), now_);
    }
    int TakeStamp_ms() {
        FrameInbox::Visit visit(inbox_);
        const auto stamp = visit.Take(kCamera).view().header.captured_at;
        return static_cast<int>(std::chrono::duration_cast<milliseconds>(stamp).count());
    }

    static constexpr std::size_t kCamera = 1;
    static constexpr int kSlots = 4;
    hal::FramePool pool_{{16, 8, hal::PixelFormat::kGrey, hal::Range::kFull}, kSlots};
    hal::Instant now_ = milliseconds(1000);
    FrameInbox inbox_{2, now_};
};

TEST_F(FrameInboxTest, AFrameFromBeforeTheLastOneGoesBackAndIsTold) {
    for (const int stamp_ms : {100, 90, 90}) Put(stamp_ms);
    EXPECT_EQ(pool_.free_count(), kSlots - 1);
    EXPECT_EQ(inbox_.counts(kCamera).disordered, 2U);
    EXPECT_EQ(FrameInbox::Visit(inbox_).TakeRefused().disordered, CameraMask(0b10));
    EXPECT_TRUE(FrameInbox::Visit(inbox_).TakeRefused().disordered.none()) << "told once";
    EXPECT_EQ(TakeStamp_ms(), 100);
}

TEST_F(FrameInboxTest, AfterASingleStepBackTheCameraIsTakenAtItsNewTime) {
    for (const int stamp_ms : {5000, 100, 133}) Put(stamp_ms);
    EXPECT_EQ(inbox_.counts(kCamera).disordered, 1U);
    EXPECT_EQ(TakeStamp_ms(), 5000);
    EXPECT_EQ(TakeStamp_ms(), 133);
}

TEST_F(FrameInboxTest, ACameraWhoseStampsStandStillIsNotHeard) {
    now_ = milliseconds(2000);
    Put(500);
    EXPECT_EQ(FrameInbox::Visit(inbox_).heard_at(), now_);
    for (int i = 0; i < 3; ++i) {
        now_ += milliseconds(33);
        Put(500);
    }
    FrameInbox::Visit visit(inbox_);
    EXPECT_EQ(visit.heard_at(), milliseconds(2000));
    EXPECT_FALSE(visit.Pending(now_, milliseconds(99)).awaited[kCamera]);
}

TEST_F(FrameInboxTest, TheTwoNewestWaitAndEveryFrameIsCounted) {
    for (const int stamp_ms : {0, 33, 67, 100}) Put(stamp_ms + 1);
    const InboxCounts counts = inbox_.counts(kCamera);
    EXPECT_EQ(counts.put, 4U);
    EXPECT_EQ(counts.superseded, 2U);
    EXPECT_EQ(counts.pending, 2U);
    EXPECT_EQ(pool_.free_count(), kSlots - 2);
    EXPECT_EQ(TakeStamp_ms(), 68);
}

TEST_F(FrameInboxTest, ClosedItHoldsNothingAndTakesNothing) {
    for (const int stamp_ms : {10, 20}) Put(stamp_ms);
    inbox_.Close();
    EXPECT_EQ(pool_.free_count(), kSlots);
    Put(30);
    EXPECT_EQ(pool_.free_count(), kSlots);
    EXPECT_EQ(inbox_.counts(kCamera).put, 2U);
}

}  // namespace
}  // namespace hitchview::app
