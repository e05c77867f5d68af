#include <gtest/gtest.h>

#include <vector>

#include "hal/fake_camera.hpp"
#include "hal/fake_can_bus.hpp"
#include "hal/fake_clock.hpp"
#include "hal/fake_publisher.hpp"
#include "hal/fake_watchdog.hpp"

namespace hitchview::hal {
namespace {

using std::chrono::milliseconds;

TEST(FakeCameraTest, PlaysItsScriptInOrder) {
    FakeCamera camera({.width_px = 4, .height_px = 2},
                      {FakeFrame{.header = {.sequence = 5}, .fill = 9}, Error::kCorrupted});
    {
        const Result<FrameLease> frame = camera.WaitFrame(milliseconds(1));
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame.value().view().header.sequence, 5U);
        EXPECT_EQ(frame.value().view().planes[0].data[7], 9);
    }
    EXPECT_EQ(camera.WaitFrame(milliseconds(1)).error(), Error::kCorrupted);
    EXPECT_EQ(camera.WaitFrame(milliseconds(1)).error(), Error::kEndOfStream);
}

TEST(FakeCameraTest, HoldsItsFrameBackWhileAllAreLent) {
    FakeCamera camera({.width_px = 4, .height_px = 2}, {FakeFrame{}, FakeFrame{}}, 1);
    Result<FrameLease> first = camera.WaitFrame(milliseconds(1));
    EXPECT_EQ(camera.WaitFrame(milliseconds(1)).error(), Error::kTimeout);
    first->Release();
    EXPECT_TRUE(camera.WaitFrame(milliseconds(1)));
}

TEST(FakeCanBusTest, PlaysItsScriptInOrder) {
    FakeCanBus bus({CanFrame{.id = 0x457}, Error::kTimeout});
    EXPECT_EQ(bus.WaitFrame(milliseconds(1)).value().id, 0x457U);
    EXPECT_EQ(bus.WaitFrame(milliseconds(1)).error(), Error::kTimeout);
    EXPECT_EQ(bus.WaitFrame(milliseconds(1)).error(), Error::kEndOfStream);
}

TEST(FakePublisherTest, KeepsACopyOfWhatItWasLent) {
    FakePublisher fake;
    Publisher& publisher = fake;
    {
        const std::vector<std::uint8_t> jpeg{1, 2, 3};
        EXPECT_TRUE(publisher.Publish(PanoramaImage{.sequence = 4, .jpeg = jpeg}));
    }
    fake.refusal = Error::kFailed;
    EXPECT_FALSE(publisher.Publish(PanoramaStatus{}));
    ASSERT_EQ(fake.images.size(), 1U);
    EXPECT_EQ(fake.images[0].image.sequence, 4U);
    EXPECT_EQ(fake.images[0].jpeg, (std::vector<std::uint8_t>{1, 2, 3}));
    EXPECT_TRUE(fake.statuses.empty());
    EXPECT_FALSE(publisher.Publish(Event{}));
    fake.refusal.reset();
    EXPECT_TRUE(publisher.Publish(Event{.code = EventCode::kCameraBack}));
    ASSERT_EQ(fake.events.size(), 1U);
    EXPECT_EQ(fake.events[0].code, EventCode::kCameraBack);
}

TEST(FakeClockTest, TimePassesOnlyWhenToldOrSlept) {
    FakeClock fake;
    Clock& clock = fake;
    fake.Advance(milliseconds(5));
    EXPECT_EQ(clock.Now(), milliseconds(5));
    clock.SleepUntil(milliseconds(20));
    clock.SleepUntil(milliseconds(10));
    EXPECT_EQ(clock.Now(), milliseconds(20));
    EXPECT_EQ(clock.EpochMicroseconds(milliseconds(1)) - clock.EpochMicroseconds(Instant(0)), 1000);
}

TEST(FakeWatchdogTest, Counts) {
    FakeWatchdog fake;
    Watchdog& watchdog = fake;
    watchdog.Ready();
    watchdog.Feed();
    watchdog.Feed();
    watchdog.Show({});
    watchdog.Stop();
    EXPECT_EQ(fake.readies, 1);
    EXPECT_EQ(fake.feeds, 2);
    EXPECT_EQ(fake.shown, 1);
    EXPECT_EQ(fake.stops, 1);
}

}  // namespace
}  // namespace hitchview::hal
