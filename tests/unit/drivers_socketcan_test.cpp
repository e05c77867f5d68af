#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "drivers/socketcan_bus.hpp"
#include "drivers/socketcan_interfaces.hpp"
#include "drivers/socketcan_time.hpp"

namespace hitchview::drivers {
namespace {

using hal::Instant;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

// A bus whose true moments are known: CLOCK_MONOTONIC with a wall clock and a controller's clock
// beside it.
class Clocks {
 public:
    SocketCanTime Start() const { return SocketCanTime(now + wall_offset, now); }
    // A frame that came at `now` and is read `waited` later.
    SocketCanStamps FrameNow(Instant waited) {
        SocketCanStamps stamps{.software = now + wall_offset + delay};
        if (has_hardware) stamps.hardware = now + hardware_offset;
        now += waited;
        stamps.now = now;
        stamps.wall_now = now + wall_offset;
        return stamps;
    }

    Instant now = seconds(1000);
    Instant wall_offset = seconds(1'700'000'000);
    Instant hardware_offset = seconds(5);
    Instant delay{};  // of the software stamp behind the frame
    bool has_hardware = false;
};

TEST(SocketCanTimeTest, ASoftwareStampIsMovedToTheMonotonicClock) {
    Clocks clocks;
    SocketCanTime time = clocks.Start();
    for (int i = 0; i < 100; ++i) {
        clocks.now += milliseconds(20);
        const Instant came = clocks.now;
        EXPECT_EQ(time.ReceivedAt(clocks.FrameNow(milliseconds(i % 7))), came);
    }
}

TEST(SocketCanTimeTest, AFrameWithoutAStampIsReceivedWhenItIsRead) {
    SocketCanTime time(Instant(0), Instant(0));
    EXPECT_EQ(time.ReceivedAt({.wall_now = seconds(9), .now = seconds(3)}), seconds(3));
}

TEST(SocketCanTimeTest, AStepOfTheWallClockHarmsNoFrameBeforeDuringOrAfterIt) {
    for (const seconds step : {seconds(3600), seconds(-3600), seconds(5), seconds(-5)}) {
        Clocks clocks;
        SocketCanTime time = clocks.Start();
        clocks.now += seconds(10);
        // Stamped before the step, read after it.
        const Instant came = clocks.now;
        SocketCanStamps stamps = clocks.FrameNow(milliseconds(30));
        clocks.wall_offset += step;
        stamps.wall_now += step;
        EXPECT_EQ(time.ReceivedAt(stamps), came) << step.count();
        // Stamped after it.
        clocks.now += milliseconds(1);
        const Instant next = clocks.now;
        EXPECT_EQ(time.ReceivedAt(clocks.FrameNow(milliseconds(5))), next) << step.count();
    }
}

TEST(SocketCanTimeTest, AStepThatIsSmallerThanTheWaitCostsNoMoreThanTheWait) {
    Clocks clocks;
    SocketCanTime time = clocks.Start();
    clocks.now += seconds(1);
    const Instant came = clocks.now;
    SocketCanStamps stamps = clocks.FrameNow(milliseconds(50));
    clocks.wall_offset -= milliseconds(20);
    stamps.wall_now -= milliseconds(20);
    const Instant received_at = time.ReceivedAt(stamps);
    EXPECT_GE(received_at, came);
    EXPECT_LE(received_at, clocks.now);
}

TEST(SocketCanTimeTest, MomentsNeverStepBackNorRunAheadWhateverTheClocksDo) {
    std::mt19937 random(1);
    const auto any = [&](Instant most) {
        return Instant(random() % static_cast<std::uint64_t>(most.count()));
    };
    Clocks clocks;
    clocks.has_hardware = true;
    SocketCanTime time = clocks.Start();
    Instant last{};
    for (int i = 0; i < 100'000; ++i) {
        clocks.now += any(milliseconds(40));
        if (i % 50 == 0) clocks.wall_offset += any(seconds(20)) - seconds(10);
        if (i % 70 == 0) clocks.hardware_offset = any(seconds(1000));
        SocketCanStamps stamps = clocks.FrameNow(any(milliseconds(10)));
        if (i % 3 == 0) stamps.hardware.reset();
        if (i % 5 == 0) stamps.software.reset();
        const Instant received_at = time.ReceivedAt(stamps);
        ASSERT_GE(received_at, last);
        ASSERT_LE(received_at, stamps.now);
        last = received_at;
    }
}

TEST(SocketCanTimeTest, HardwareStampsTakeTheJitterOfTheSoftwareStampsAway) {
    std::mt19937 random(1);
    Clocks clocks;
    clocks.has_hardware = true;
    SocketCanTime time = clocks.Start();
    Instant worst{};
    for (int i = 0; i < 10'000; ++i) {
        clocks.now += milliseconds(10);
        clocks.hardware_offset += Instant(500);  // 50 ppm fast
        clocks.delay = microseconds(random() % 2000);
        const Instant came = clocks.now;
        const Instant received_at = time.ReceivedAt(clocks.FrameNow(milliseconds(3)));
        if (i > 100) worst = std::max<Instant>(worst, std::chrono::abs(received_at - came));
    }
    EXPECT_LT(worst, microseconds(300)) << "of 2000 us that the software stamps are late";
}

TEST(SocketCanTimeTest, AControllersClockThatJumpsIsMeasuredAfresh) {
    Clocks clocks;
    clocks.has_hardware = true;
    SocketCanTime time = clocks.Start();
    for (const Instant jump : {Instant(seconds(0)), Instant(seconds(-4)), Instant(seconds(900))}) {
        clocks.hardware_offset += jump;
        for (int i = 0; i < 300; ++i) {
            clocks.now += milliseconds(10);
            const Instant came = clocks.now;
            ASSERT_EQ(time.ReceivedAt(clocks.FrameNow(milliseconds(2))), came);
        }
    }
}

TEST(SocketCanInterfacesTest, AMissingInterfaceIsNamed) {
    const auto checked = CheckCanInterface("nosuchcan0");
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error(), HasSubstr("there is no interface 'nosuchcan0'"));
    EXPECT_FALSE(CheckCanInterface(""));
    EXPECT_FALSE(CheckCanInterface("a_name_that_no_kernel_would_take"));
}

TEST(SocketCanInterfacesTest, AnInterfaceThatIsNoCanInterfaceIsRefusedAndNotListed) {
    const auto bus = SocketCanBus::Open({.interface = "lo"});
    ASSERT_FALSE(bus);
    EXPECT_THAT(bus.error(), HasSubstr("'lo' is not a CAN interface"));
    EXPECT_THAT(CanInterfaces(), testing::Not(testing::Contains("lo")));
}

TEST(SocketCanBusOpenTest, MoreIdsThanTheKernelTakesAreRefused) {
    const std::vector<SocketCanId> ids(SocketCanBus::kMaxIds + 1);
    const auto bus = SocketCanBus::Open({.interface = "can0", .ids = ids});
    ASSERT_FALSE(bus);
    EXPECT_THAT(bus.error(), HasSubstr("513 identifiers, must be at most 512"));
}

}  // namespace
}  // namespace hitchview::drivers
