#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "app/candump_writer.hpp"
#include "drivers/candump_can_bus.hpp"
#include "drivers/socketcan_bus.hpp"
#include "tests/support/random_can.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_can.hpp"

// What we write and read beside the programs of can-utils.
namespace hitchview::app {
namespace {

using hal::CanFrame;
using hal::CanFrameKind;
using std::chrono::milliseconds;

constexpr milliseconds kSoon{500};

canid_t RawId(const CanFrame& frame) {
    if (frame.kind == CanFrameKind::kError) return frame.id | CAN_ERR_FLAG;
    const canid_t remote = frame.kind == CanFrameKind::kRemote ? CAN_RTR_FLAG : 0;
    return frame.id | remote | (frame.extended ? CAN_EFF_FLAG : 0);
}

bool Send(tests::CanSender& sender, const CanFrame& frame) {
    canfd_frame raw{};
    raw.can_id = RawId(frame);
    raw.len = frame.size_bytes;
    raw.flags = frame.fd_flags;
    std::copy_n(frame.data.begin(), frame.size_bytes, std::begin(raw.data));
    if (frame.fd) return sender.Send(raw);
    can_frame classic{};
    std::memcpy(&classic, &raw, sizeof classic);
    return sender.Send(classic);
}

std::vector<CanFrame> ReadUntilSilent(hal::CanBus& bus) {
    std::vector<CanFrame> frames;
    for (auto frame = bus.WaitFrame(kSoon); frame; frame = bus.WaitFrame(kSoon))
        frames.push_back(frame.value());
    return frames;
}

// Without what two buses cannot have in common.
CanFrame Content(CanFrame frame) {
    frame.received_at = frame.epoch = {};
    frame.fd_flags &= CANFD_BRS | CANFD_ESI;
    return frame;
}

void Write(const std::string& file, const std::string& interface,
           const std::vector<CanFrame>& frames) {
    auto writer = CandumpWriter::Open(file, interface);
    ASSERT_TRUE(writer) << writer.error();
    for (const CanFrame& frame : frames) (*writer)->Append(frame);
    ASSERT_TRUE((*writer)->Finish());
}

class SocketCanCandumpTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::HasVirtualCan()) GTEST_SKIP() << "no virtual CAN interfaces here";
        if (tests::Shell("command -v candump canplayer cangen cansend >/dev/null") != 0)
            GTEST_SKIP() << "no can-utils here";
        can_ = std::make_unique<tests::VirtualCan>("vcan0");
        bus_ = Open("vcan0");
    }

    static std::unique_ptr<drivers::SocketCanBus> Open(const char* interface) {
        auto bus = drivers::SocketCanBus::Open({.interface = interface, .record = true});
        EXPECT_TRUE(bus) << bus.error();
        return std::move(*bus);
    }

    // Runs until nothing has come for two seconds, with remote and error frames.
    std::thread Candump(const std::string& file) {
        return std::thread(
            [file] { tests::Shell("candump -L -T 2000 vcan0,0:0,#FFFFFFFF >" + file); });
    }

    tests::TemporaryFolder folder_;
    std::unique_ptr<tests::VirtualCan> can_;
    std::unique_ptr<drivers::SocketCanBus> bus_;
};

TEST_F(SocketCanCandumpTest, OurLogOfTheSameTrafficIsThatOfCandumpByteForByte) {
    std::thread candump = Candump(folder_ / "theirs.log");
    std::this_thread::sleep_for(kSoon);
    tests::CanSender sender("vcan0");
    tests::RandomCan random(5);
    for (int i = 0; i < 2000; ++i) {
        ASSERT_TRUE(Send(sender, random.Frame()));
        if (i % 20 == 0) std::this_thread::sleep_for(milliseconds(5));
    }
    Write(folder_ / "ours.log", "vcan0", ReadUntilSilent(*bus_));
    candump.join();
    const std::string ours = tests::FileText(folder_ / "ours.log");
    EXPECT_EQ(std::ranges::count(ours, '\n'), 2000);
    EXPECT_TRUE(ours == tests::FileText(folder_ / "theirs.log"))
        << "first lines of ours:\n"
        << ours.substr(0, 300) << "\nof theirs:\n"
        << tests::FileText(folder_ / "theirs.log").substr(0, 300);
}

TEST_F(SocketCanCandumpTest, OurImporterReadsWhatCandumpWrote) {
    std::thread candump = Candump(folder_ / "theirs.log");
    std::this_thread::sleep_for(kSoon);
    // Classic of both formats with remote frames, then FD.
    tests::Shell("cangen vcan0 -n 300 -g 1 -m -R 2>/dev/null");
    const std::vector<CanFrame> sent = ReadUntilSilent(*bus_);
    candump.join();
    auto log = drivers::CandumpCanBus::Open(folder_ / "theirs.log", hal::Instant{0},
                                            drivers::CandumpCanBus::Kinds::kAll);
    ASSERT_TRUE(log) << log.error();
    const std::vector<CanFrame> read = ReadUntilSilent(**log);
    ASSERT_EQ(sent.size(), 300U);
    ASSERT_EQ(read.size(), sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
        EXPECT_EQ(Content(read[i]), Content(sent[i])) << i;
        EXPECT_EQ(read[i].epoch, std::chrono::floor<std::chrono::microseconds>(sent[i].epoch)) << i;
    }
}

TEST_F(SocketCanCandumpTest, CanplayerSendsTheFramesOfOurLog) {
    tests::RandomCan random(9);
    std::vector<CanFrame> frames;
    for (int i = 0; i < 500; ++i) {
        CanFrame frame = random.Frame();
        frame.epoch = std::chrono::seconds(1'700'000'000) + milliseconds(i);
        frames.push_back(frame);
    }
    Write(folder_ / "ours.log", "can0", frames);
    ASSERT_EQ(tests::Shell("canplayer -I " + (folder_ / "ours.log") + " vcan0=can0"), 0);
    const std::vector<CanFrame> played = ReadUntilSilent(*bus_);
    ASSERT_EQ(played.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i)
        EXPECT_EQ(Content(played[i]), Content(frames[i])) << i;
}

TEST_F(SocketCanCandumpTest, CansendIsReceived) {
    ASSERT_EQ(tests::Shell("cansend vcan0 18FF7A27#0011 && cansend vcan0 123##1AABB"), 0);
    const std::vector<CanFrame> frames = ReadUntilSilent(*bus_);
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].id, 0x18ff7a27U);
    EXPECT_EQ(frames[1].fd_flags & CANFD_BRS, CANFD_BRS);
    EXPECT_EQ(frames[1].data[1], 0xbb);
}

}  // namespace
}  // namespace hitchview::app
