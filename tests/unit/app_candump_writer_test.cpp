#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "app/candump_writer.hpp"
#include "drivers/candump_can_bus.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/random_can.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using hal::CanFrame;
using hal::CanFrameKind;
using std::chrono::microseconds;
using std::chrono::seconds;

std::string LineOf(CanFrame frame) {
    frame.epoch = seconds(1'700'000'000) + microseconds(123456) + std::chrono::nanoseconds(999);
    CandumpLine line("can0");
    return std::string(line.Format(frame));
}

TEST(CandumpLineTest, LinesAreThoseOfCandump) {
    CanFrame frame{.id = 0x57, .size_bytes = 3, .data = {0x00, 0xab, 0x0f}};
    EXPECT_EQ(LineOf(frame), "(1700000000.123456) can0 057#00AB0F\n");
    frame.extended = true;
    EXPECT_EQ(LineOf(frame), "(1700000000.123456) can0 00000057#00AB0F\n");
    frame.fd = true;
    frame.fd_flags = 5;
    EXPECT_EQ(LineOf(frame), "(1700000000.123456) can0 00000057##500AB0F\n");
    EXPECT_EQ(LineOf({.id = 0x7ff}), "(1700000000.123456) can0 7FF#\n");
    EXPECT_EQ(LineOf({.id = 1, .kind = CanFrameKind::kRemote}), "(1700000000.123456) can0 001#R\n");
    EXPECT_EQ(LineOf({.id = 1, .kind = CanFrameKind::kRemote, .size_bytes = 8}),
              "(1700000000.123456) can0 001#R8\n");
    EXPECT_EQ(LineOf({.id = 4, .extended = true, .kind = CanFrameKind::kError, .size_bytes = 8}),
              "(1700000000.123456) can0 20000004#0000000000000000\n");
}

TEST(CandumpLineTest, TimesHaveTenAndSixDigits) {
    CandumpLine line("can0");
    EXPECT_EQ(line.Format({.id = 1, .epoch = microseconds(1)}).substr(0, 20),
              "(0000000000.000001) ");
    EXPECT_EQ(line.Format({.id = 1, .epoch = seconds(999)}).substr(0, 20), "(0000000999.000000) ");
}

TEST(CandumpLineTest, TakesNoMemoryAndHasRoomForTheLongestLine) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    CandumpLine line("fifteen_letters");
    const CanFrame frame{.id = 0x1fffffff, .extended = true, .fd = true, .size_bytes = 64};
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    const std::size_t length = line.Format(frame).size();
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
    EXPECT_EQ(length, 19U + 1 + 15 + 1 + 8 + 3 + 128 + 1);
}

TEST(CandumpWriterTest, WhatIsWrittenIsReadAsTheSameFrames) {
    const tests::TemporaryFolder folder;
    const std::string file = folder / "can0.log";
    tests::RandomCan random(3);
    std::vector<CanFrame> written;
    auto writer = CandumpWriter::Open(file, "can0");
    ASSERT_TRUE(writer) << writer.error();
    for (int i = 0; i < 10'000; ++i) {
        CanFrame frame = random.Frame();
        frame.epoch = seconds(1'700'000'000) + microseconds(137) * i;
        frame.received_at = seconds(7) + microseconds(137) * i;
        (*writer)->Append(frame);
        written.push_back(frame);
    }
    ASSERT_TRUE((*writer)->Finish());

    auto bus = drivers::CandumpCanBus::Open(file, seconds(7), drivers::CandumpCanBus::Kinds::kAll);
    ASSERT_TRUE(bus) << bus.error();
    for (const CanFrame& frame : written) {
        const auto read = (*bus)->WaitFrame(std::chrono::milliseconds(1));
        ASSERT_TRUE(read);
        ASSERT_EQ(read.value(), frame) << LineOf(frame) << LineOf(read.value());
    }
    EXPECT_FALSE((*bus)->WaitFrame(std::chrono::milliseconds(1)));
}

TEST(CandumpWriterTest, AFileThatCannotBeWrittenIsNamed) {
    const auto writer = CandumpWriter::Open("/nowhere/can0.log", "can0");
    ASSERT_FALSE(writer);
    EXPECT_THAT(writer.error(),
                testing::HasSubstr("/nowhere/can0.log: cannot be written: No such"));
}

TEST(CandumpWriterTest, AFullDiskIsTold) {
    auto writer = CandumpWriter::Open("/dev/full", "can0");
    ASSERT_TRUE(writer);
    for (int i = 0; i < 10'000; ++i) (*writer)->Append({.id = 1});
    EXPECT_FALSE((*writer)->Finish());
}

}  // namespace
}  // namespace hitchview::app
