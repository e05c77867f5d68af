#include "drivers/socketcan_bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <unistd.h>

#include <ctime>
#include <thread>

#include "tests/support/heap_calls.hpp"
#include "tests/support/refused_call.hpp"
#include "tests/support/virtual_can.hpp"

namespace hitchview::drivers {
namespace {

using hal::CanFrame;
using hal::CanFrameKind;
using hal::Error;
using hal::Instant;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr milliseconds kSoon{500};
constexpr milliseconds kShort{20};

Instant Now() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

can_frame Frame(canid_t id, std::uint32_t number = 0) {
    can_frame frame{};
    frame.can_id = id;
    frame.len = 8;
    for (int i = 0; i < 4; ++i) frame.data[i] = static_cast<std::uint8_t>(number >> (8 * i));
    return frame;
}

std::uint32_t NumberIn(const CanFrame& frame) {
    std::uint32_t number = 0;
    for (int i = 3; i >= 0; --i) number = number << 8 | frame.data[i];
    return number;
}

std::unique_ptr<SocketCanBus> MustOpen(const SocketCanOptions& options) {
    auto bus = SocketCanBus::Open(options);
    EXPECT_TRUE(bus) << bus.error();
    return bus ? std::move(*bus) : nullptr;
}

// The error of a call that must have no frame.
Error ErrorOf(const hal::Result<CanFrame>& frame) {
    EXPECT_FALSE(frame);
    return frame ? Error::kFailed : frame.error();
}

class SocketCanBusTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::HasVirtualCan()) GTEST_SKIP() << "no virtual CAN interfaces here";
        can_ = std::make_unique<tests::VirtualCan>("vcan0");
        bus_ = MustOpen({.interface = "vcan0"});
        sender_ = std::make_unique<tests::CanSender>("vcan0");
    }

    // Restarts the count of what `call` takes from the heap.
    template <typename Call>
    auto WithoutHeap(const Call& call) {
        const std::uint64_t before = tests::HeapCallsOfThisThread();
        const auto result = call();
        EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
        return result;
    }

    hal::Result<CanFrame> Wait(milliseconds timeout) {
        return WithoutHeap([&] { return bus_->WaitFrame(timeout); });
    }

    // The first outcome but `error`, in five seconds.
    hal::Result<CanFrame> WaitWhile(Error error) {
        const Instant until = Now() + std::chrono::seconds(5);
        auto frame = Wait(kShort);
        while (!frame && frame.error() == error && Now() < until) frame = Wait(kShort);
        return frame;
    }

    std::unique_ptr<tests::VirtualCan> can_;
    std::unique_ptr<SocketCanBus> bus_;
    std::unique_ptr<tests::CanSender> sender_;
};

TEST_F(SocketCanBusTest, ClassicFramesOfBothFormatsComeAsTheyWereSent) {
    can_frame standard = Frame(0x457, 0x01020304);
    can_frame extended = Frame(0x457 | CAN_EFF_FLAG);
    extended.len = 3;
    ASSERT_TRUE(sender_->Send(standard) && sender_->Send(extended));
    const auto first = Wait(kSoon);
    ASSERT_TRUE(first);
    EXPECT_EQ(first.value().id, 0x457U);
    EXPECT_FALSE(first.value().extended || first.value().fd);
    EXPECT_EQ(first.value().size_bytes, 8);
    EXPECT_EQ(NumberIn(first.value()), 0x01020304U);
    const auto second = Wait(kSoon);
    ASSERT_TRUE(second);
    EXPECT_TRUE(second.value().extended);
    EXPECT_EQ(second.value().size_bytes, 3);
}

TEST_F(SocketCanBusTest, AnFdFrameComesWithItsFlagsAndAllItsBytes) {
    canfd_frame frame{};
    frame.can_id = 0x18ff7a27 | CAN_EFF_FLAG;
    frame.len = 64;
    frame.flags = CANFD_BRS | CANFD_ESI;
    for (int i = 0; i < 64; ++i) frame.data[i] = static_cast<std::uint8_t>(3 * i);
    ASSERT_TRUE(sender_->Send(frame));
    const auto got = Wait(kSoon);
    ASSERT_TRUE(got);
    EXPECT_TRUE(got.value().fd && got.value().extended);
    EXPECT_EQ(got.value().id, 0x18ff7a27U);
    EXPECT_EQ(got.value().fd_flags & 3, CANFD_BRS | CANFD_ESI);
    EXPECT_EQ(got.value().size_bytes, 64);
    EXPECT_EQ(got.value().data[63], 3 * 63);
}

TEST_F(SocketCanBusTest, OnlyTheConfiguredIdsInTheirFormatAndNoRemoteFramesAreHandedOver) {
    bus_ = MustOpen({.interface = "vcan0", .ids = {{0x100}, {0x100, true}, {0x18ff7a27, true}}});
    for (const canid_t id : {0x101U, 0x100U | CAN_RTR_FLAG, 0x7a27U | CAN_EFF_FLAG,
                             0x18ff7a27U | CAN_EFF_FLAG | CAN_RTR_FLAG, 0x727U}) {
        ASSERT_TRUE(sender_->Send(Frame(id)));
    }
    for (const canid_t id : {0x100U, 0x100U | CAN_EFF_FLAG, 0x18ff7a27U | CAN_EFF_FLAG})
        ASSERT_TRUE(sender_->Send(Frame(id, id)));
    for (const canid_t id : {0x100U, 0x100U | CAN_EFF_FLAG, 0x18ff7a27U | CAN_EFF_FLAG}) {
        const auto frame = Wait(kSoon);
        ASSERT_TRUE(frame);
        EXPECT_EQ(NumberIn(frame.value()), id);
    }
    EXPECT_EQ(ErrorOf(Wait(kShort)), Error::kTimeout);
    EXPECT_EQ(bus_->counts().delivered, 3U);
}

TEST_F(SocketCanBusTest, WithoutIdsAllDataFramesAreHandedOverAndStillNoRemoteFrames) {
    ASSERT_TRUE(sender_->Send(Frame(0x100 | CAN_RTR_FLAG)) && sender_->Send(Frame(0x101)));
    const auto frame = Wait(kSoon);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame.value().id, 0x101U);
}

TEST_F(SocketCanBusTest, ARecorderGetsRemoteAndErrorFramesToo) {
    bus_ = MustOpen({.interface = "vcan0", .record = true});
    ASSERT_TRUE(sender_->Send(Frame(0x100 | CAN_RTR_FLAG)));
    ASSERT_TRUE(sender_->Send(Frame(CAN_ERR_FLAG | CAN_ERR_ACK)));
    const auto remote = Wait(kSoon);
    ASSERT_TRUE(remote);
    EXPECT_EQ(remote.value().kind, CanFrameKind::kRemote);
    EXPECT_EQ(remote.value().size_bytes, 8);
    const auto error = Wait(kSoon);
    ASSERT_TRUE(error);
    EXPECT_EQ(error.value().kind, CanFrameKind::kError);
    EXPECT_EQ(error.value().id, static_cast<std::uint32_t>(CAN_ERR_ACK));
    EXPECT_EQ(bus_->counts().errors, 1U);
}

TEST_F(SocketCanBusTest, AFrameIsReceivedAtTheMomentTheKernelGotItNotWhenItIsRead) {
    const Instant before = Now();
    ASSERT_TRUE(sender_->Send(Frame(1)));
    const Instant after = Now() + milliseconds(1);  // the bus delivers from a soft interrupt
    std::this_thread::sleep_for(milliseconds(200));
    const auto frame = Wait(kSoon);
    ASSERT_TRUE(frame);
    EXPECT_GE(frame.value().received_at, before);
    EXPECT_LT(frame.value().received_at, after + milliseconds(100));
}

class WallClockStep {
 public:
    explicit WallClockStep(std::chrono::seconds by) : by_(by) { Step(by_); }
    ~WallClockStep() { Step(-by_); }
    WallClockStep(const WallClockStep&) = delete;
    WallClockStep& operator=(const WallClockStep&) = delete;

 private:
    static void Step(std::chrono::seconds by) {
        timespec time{};
        clock_gettime(CLOCK_REALTIME, &time);
        time.tv_sec += by.count();
        ASSERT_EQ(clock_settime(CLOCK_REALTIME, &time), 0);
    }

    std::chrono::seconds by_;
};

TEST_F(SocketCanBusTest, SettingTheWallClockHarmsNoTimeStamp) {
    for (const int hours : {1, -1}) {
        ASSERT_TRUE(sender_->Send(Frame(1)));
        ASSERT_TRUE(Wait(kSoon));
        const Instant before = Now();
        ASSERT_TRUE(sender_->Send(Frame(2)));
        std::this_thread::sleep_for(milliseconds(50));
        const WallClockStep step{std::chrono::hours(hours)};
        ASSERT_TRUE(sender_->Send(Frame(3)));
        const Instant after = Now();
        const auto waited = Wait(kSoon);
        const auto next = Wait(kSoon);
        ASSERT_TRUE(waited && next);
        EXPECT_GE(waited.value().received_at, before) << hours;
        EXPECT_LT(waited.value().received_at, after) << hours;
        EXPECT_GT(next.value().received_at, waited.value().received_at) << hours;
        EXPECT_LT(next.value().received_at, after + milliseconds(200)) << hours;
    }
}

TEST_F(SocketCanBusTest, FramesWithoutRoomAreCountedAlsoThoseAfterTheLastThatCame) {
    bus_ = MustOpen({.interface = "vcan0", .receive_buffer_bytes = 4096});
    constexpr std::uint64_t kSent = 2000;
    for (std::uint32_t i = 0; i < kSent; ++i) ASSERT_TRUE(sender_->Send(Frame(1, i)));
    while (Wait(kShort)) {
    }
    const hal::CanCounts counts = bus_->counts();
    EXPECT_GT(counts.delivered, 0U);
    EXPECT_GT(counts.dropped, 1000U);
    EXPECT_EQ(counts.delivered + counts.dropped, kSent);
}

TEST_F(SocketCanBusTest, AUserWhoMayNotHaveTheBufferThatIsAskedForIsToldHow) {
    EXPECT_EQ(bus_->remark(), "") << "root may";
    constexpr uid_t kNobody = 65534;
    ASSERT_EQ(seteuid(kNobody), 0);
    bus_ = MustOpen({.interface = "vcan0", .receive_buffer_bytes = 64 << 20});
    ASSERT_EQ(seteuid(0), 0);
    EXPECT_THAT(bus_->remark(), HasSubstr("bytes instead of 67108864"));
    EXPECT_THAT(bus_->remark(), HasSubstr("sysctl -w net.core.rmem_max=67108864"));
    ASSERT_TRUE(sender_->Send(Frame(1)));
    EXPECT_TRUE(Wait(kSoon)) << "it is used all the same";
}

TEST_F(SocketCanBusTest, AMillionFramesAtFullRateComeInOrderOrAreCountedAsDropped) {
    constexpr std::uint32_t kBatch = 250;
    constexpr std::uint32_t kSent = 1'000'000;
    std::thread load([&] {
        std::vector<can_frame> frames(kBatch);
        for (std::uint32_t i = 0; i < kSent; i += kBatch) {
            for (std::uint32_t j = 0; j < kBatch; ++j)
                frames[j] = Frame(0x18ff7a27 | CAN_EFF_FLAG, i + j);
            sender_->Send(frames);
        }
    });
    std::int64_t last = -1;
    Instant last_at{};
    std::uint64_t got = 0;
    std::uint64_t disordered = 0;
    const Instant start = Now();
    for (auto frame = Wait(kSoon); frame; frame = Wait(kSoon)) {
        const std::int64_t number = NumberIn(frame.value());
        if (number <= last || frame.value().received_at < last_at) ++disordered;
        last = number;
        last_at = frame.value().received_at;
        ++got;
    }
    load.join();
    while (Wait(kSoon)) ++got;
    const auto seconds = std::chrono::duration<double>(Now() - start).count();
    std::printf("%.0f s: %llu delivered, %llu dropped\n", seconds,
                static_cast<unsigned long long>(got),
                static_cast<unsigned long long>(bus_->counts().dropped));
    EXPECT_EQ(disordered, 0U);
    EXPECT_EQ(bus_->counts().delivered, got);
    EXPECT_EQ(got + bus_->counts().dropped, kSent);
}

TEST_F(SocketCanBusTest, ErrorFramesAreCountedAndNotHandedOver) {
    ASSERT_TRUE(sender_->Send(Frame(CAN_ERR_FLAG | CAN_ERR_CRTL)));
    ASSERT_TRUE(sender_->Send(Frame(CAN_ERR_FLAG | CAN_ERR_BUSERROR)));
    ASSERT_TRUE(sender_->Send(Frame(0x123)));
    const auto frame = Wait(kSoon);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame.value().id, 0x123U);
    EXPECT_EQ(bus_->counts().errors, 2U);
    EXPECT_EQ(bus_->counts().disconnections, 0U);
}

TEST_F(SocketCanBusTest, BusOffDisconnectsUntilAFrameComes) {
    ASSERT_TRUE(sender_->Send(Frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF)));
    EXPECT_EQ(ErrorOf(Wait(kSoon)), Error::kDisconnected);
    EXPECT_EQ(ErrorOf(Wait(kShort)), Error::kDisconnected);
    ASSERT_TRUE(sender_->Send(Frame(1)));
    EXPECT_TRUE(Wait(kSoon));
    EXPECT_EQ(ErrorOf(Wait(kShort)), Error::kTimeout);
    EXPECT_EQ(bus_->counts().disconnections, 1U);
}

TEST_F(SocketCanBusTest, BusOffEndsWhenTheControllerWasRestartedThoughTheBusIsSilent) {
    ASSERT_TRUE(sender_->Send(Frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF)));
    EXPECT_EQ(ErrorOf(Wait(kSoon)), Error::kDisconnected);
    ASSERT_TRUE(sender_->Send(Frame(CAN_ERR_FLAG | CAN_ERR_RESTARTED)));
    EXPECT_EQ(ErrorOf(Wait(kShort)), Error::kTimeout);
    EXPECT_EQ(bus_->counts().errors, 2U);
}

TEST_F(SocketCanBusTest, AnInterfaceThatGoesDownDisconnectsUntilItIsUpAgain) {
    for (std::uint64_t times = 1; times <= 3; ++times) {
        ASSERT_TRUE(sender_->Send(Frame(1)));
        can_->Down();
        EXPECT_EQ(ErrorOf(Wait(kSoon)), Error::kDisconnected);
        EXPECT_TRUE(Wait(kSoon)) << "what came before is still there";
        EXPECT_EQ(ErrorOf(Wait(kShort)), Error::kDisconnected);
        can_->Up();
        EXPECT_EQ(ErrorOf(WaitWhile(Error::kDisconnected)), Error::kTimeout);
        sender_ = std::make_unique<tests::CanSender>("vcan0");
        ASSERT_TRUE(sender_->Send(Frame(2)));
        EXPECT_TRUE(WaitWhile(Error::kTimeout));
        EXPECT_EQ(bus_->counts().disconnections, times);
    }
}

TEST_F(SocketCanBusTest, ADeletedInterfaceIsOpenedAgainWhenOneOfItsNameIsBack) {
    for (std::uint64_t times = 1; times <= 2; ++times) {
        can_->Delete();
        EXPECT_EQ(ErrorOf(Wait(kSoon)), Error::kDisconnected);
        EXPECT_EQ(ErrorOf(Wait(milliseconds(1200))), Error::kDisconnected);
        can_->Add();
        EXPECT_EQ(ErrorOf(WaitWhile(Error::kDisconnected)), Error::kTimeout);
        sender_ = std::make_unique<tests::CanSender>("vcan0");
        ASSERT_TRUE(sender_->Send(Frame(3, 77)));
        const auto frame = WaitWhile(Error::kTimeout);
        ASSERT_TRUE(frame);
        EXPECT_EQ(NumberIn(frame.value()), 77U);
        EXPECT_EQ(bus_->counts().disconnections, times);
    }
}

TEST_F(SocketCanBusTest, AnInterfaceMayBeDownWhenItIsOpened) {
    can_->Down();
    bus_ = MustOpen({.interface = "vcan0"});
    EXPECT_EQ(ErrorOf(Wait(kShort)), Error::kDisconnected);
    can_->Up();
    EXPECT_EQ(ErrorOf(WaitWhile(Error::kDisconnected)), Error::kTimeout);
}

TEST_F(SocketCanBusTest, AMistakenNameIsToldTheInterfacesThatThereAre) {
    const tests::VirtualCan second("vcan7");
    const auto missing = SocketCanBus::Open({.interface = "can9"});
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error(), HasSubstr("'can9'"));
    EXPECT_THAT(missing.error(), HasSubstr("vcan0 vcan7"));
    const auto loopback = SocketCanBus::Open({.interface = "lo"});
    ASSERT_FALSE(loopback);
    EXPECT_THAT(loopback.error(), HasSubstr("'lo' is not a CAN interface"));
}

TEST_F(SocketCanBusTest, WhatTheKernelRefusesIsSaidWithTheRemedy) {
    const struct {
        tests::RefusedCall call;
        const char* says;
        const char* remedy;
    } cases[] = {
        {{__NR_socket, 0, AF_CAN, EAFNOSUPPORT}, "vcan0: socket: Address family", "modprobe can_raw"},
        {{__NR_socket, 2, CAN_RAW, EPROTONOSUPPORT}, "vcan0: socket: Protocol", "RestrictAddress"},
        {{__NR_socket, 0, AF_CAN, EPERM}, "vcan0: socket: Operation not", "CAP_NET_RAW"},
        {{__NR_setsockopt, 2, CAN_RAW_FD_FRAMES, ENOPROTOOPT}, "vcan0: CAN_RAW_FD_FRAMES: ", ""},
        {{__NR_setsockopt, 2, SO_RXQ_OVFL, EINVAL}, "vcan0: SO_RXQ_OVFL: Invalid", ""},
        {{__NR_bind, 2, sizeof(sockaddr_can), EACCES}, "vcan0: bind: Permission", "CAP_NET_RAW"},
    };
    for (const auto& c : cases) {
        const bool tried = tests::WhileRefused(c.call, [&] {
            const auto bus = SocketCanBus::Open({.interface = "vcan0"});
            ASSERT_FALSE(bus) << c.says;
            EXPECT_THAT(bus.error(), HasSubstr(c.says));
            EXPECT_THAT(bus.error(), HasSubstr(c.remedy));
        });
        EXPECT_TRUE(tried) << "no filters of system calls in this kernel";
    }
}

TEST_F(SocketCanBusTest, ASilentBusTimesOutAndIsConnected) {
    const Instant start = Now();
    EXPECT_EQ(ErrorOf(Wait(milliseconds(100))), Error::kTimeout);
    EXPECT_GE(Now() - start, milliseconds(100));
    EXPECT_EQ(bus_->counts().disconnections, 0U);
}

}  // namespace
}  // namespace hitchview::drivers
