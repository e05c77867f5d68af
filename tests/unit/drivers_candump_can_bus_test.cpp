#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "drivers/candump_can_bus.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using hal::CanFrame;
using hal::Error;
using hal::Instant;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;

constexpr milliseconds kTimeout{1};
constexpr Instant kStart = std::chrono::seconds(5);

class CandumpCanBusTest : public testing::Test {
 protected:
    std::unique_ptr<CandumpCanBus> Open(const std::string& text) {
        auto bus = CandumpCanBus::Open(Write(text), kStart);
        EXPECT_TRUE(bus) << bus.error();
        return bus ? std::move(bus.value()) : nullptr;
    }

    // Why a log of this text is refused; empty when it is not.
    std::string Refusal(const std::string& text) {
        const auto bus = CandumpCanBus::Open(Write(text), kStart);
        return bus ? "" : bus.error();
    }

    std::string Write(const std::string& text) { return folder_.Write("can0.log", text); }

    tests::TemporaryFolder folder_;
    const std::string path_ = folder_ / "can0.log";
};

std::vector<int> Bytes(const CanFrame& frame) {
    return {frame.data.begin(), frame.data.begin() + frame.size_bytes};
}

std::vector<CanFrame> ReadAll(hal::CanBus& bus) {
    std::vector<CanFrame> frames;
    auto frame = bus.WaitFrame(kTimeout);
    for (; frame; frame = bus.WaitFrame(kTimeout)) frames.push_back(frame.value());
    EXPECT_EQ(frame.error(), Error::kEndOfStream);
    return frames;
}

TEST_F(CandumpCanBusTest, AStandardFrameHasItsIdAndBytes) {
    const auto frames = ReadAll(*Open("(1700000000.123456) can0 457#00112233445566EF\n"));
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].id, 1111U);
    EXPECT_FALSE(frames[0].extended);
    EXPECT_EQ(Bytes(frames[0]), (std::vector<int>{0, 17, 34, 51, 68, 85, 102, 239}));
}

TEST_F(CandumpCanBusTest, EightDigitsMakeAnExtendedIdHoweverSmall) {
    const auto frames = ReadAll(
        *Open("(1700000000.000000) can0 18FF7A27#0aFf\n(1700000000.000000) can0 00000457#\n"));
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].id, 0x18ff7a27U);
    EXPECT_TRUE(frames[0].extended);
    EXPECT_EQ(Bytes(frames[0]), (std::vector<int>{10, 255}));
    EXPECT_EQ(frames[1].id, 0x457U);
    EXPECT_TRUE(frames[1].extended);
    EXPECT_EQ(frames[1].size_bytes, 0);
}

TEST_F(CandumpCanBusTest, AnFdFrameKeepsItsBytesWithoutTheFlags) {
    const std::string bytes(128, 'A');
    const auto frames = ReadAll(*Open("(1700000000.000000) can0 457##5" + bytes + "\n"));
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(Bytes(frames[0]), std::vector<int>(64, 0xaa));
}

TEST_F(CandumpCanBusTest, TheFirstLineIsAtTheStartAndTheOthersKeepTheirDistances) {
    const auto frames =
        ReadAll(*Open("(1700000000.999999) can0 001#\n(1700000001.000001) can0 001#\n"
                      "(1700000003.999999000) can0 001#\n(1699999999.999999) can0 001#\n"));
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_EQ(frames[0].received_at, kStart);
    EXPECT_EQ(frames[1].received_at, kStart + microseconds(2));
    EXPECT_EQ(frames[2].received_at, kStart + std::chrono::seconds(3));
    EXPECT_EQ(frames[3].received_at, kStart - std::chrono::seconds(1));
}

TEST_F(CandumpCanBusTest, RemoteAndErrorFramesAreCountedAndSkipped) {
    const auto bus = Open(
        "(1700000000.000000) can0 457#R\n(1700000000.000000) can0 457#R8\n"
        "(1700000000.000000) can0 20000004#0000000000000000\n"
        "(1700000001.000000) can0 457#01\n"
        "(1700000002.000000) can0 3FFFFFFF#R\n");
    EXPECT_EQ(bus->log_counts().data, 1U);
    EXPECT_EQ(bus->log_counts().remote, 2U);
    EXPECT_EQ(bus->log_counts().error, 2U);
    const auto frames = ReadAll(*bus);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].received_at, kStart + std::chrono::seconds(1));
}

TEST_F(CandumpCanBusTest, PaddingDirectionAndAMissingLastNewlineAreTaken) {
    const auto frames =
        ReadAll(*Open("(0000000000.000000)  can0 457#01 R\n(0000000000.000000) can0 457#R T\n"
                      "(0000000000.000000) can0 457#02"));
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(Bytes(frames[0]), std::vector<int>{1});
    EXPECT_EQ(Bytes(frames[1]), std::vector<int>{2});
}

TEST_F(CandumpCanBusTest, AnEmptyFileIsASilentBus) {
    EXPECT_TRUE(ReadAll(*Open("")).empty());
}

TEST_F(CandumpCanBusTest, ABadLineIsRefusedWithFileLineAndWhatIsWrong) {
    const std::string good = "(1700000000.000000) can0 457#01\n";
    const auto refusal = [&](const std::string& line) { return Refusal(good + line + "\n"); };
    const auto says = [&](const char* what) {
        return AllOf(HasSubstr(path_ + ":2: "), HasSubstr(what));
    };
    EXPECT_THAT(refusal(""), says("line is ''"));
    EXPECT_THAT(refusal("can0  457   [1]  01"), says("must be (seconds) interface id#data"));
    EXPECT_THAT(refusal("(1700000000.000000)can0 457#01"), says("line is"));
    EXPECT_THAT(refusal("(1700000000.000000) can0"), says("line is"));
    EXPECT_THAT(refusal("(1700000000.000000) 457#01"), says("line is"));
    EXPECT_THAT(refusal("(1700000000.0000) can0 457#01"), says("time is '1700000000.0000'"));
    EXPECT_THAT(refusal("(9000000001.000000) can0 457#01"), says("time is '9000000001.000000'"));
    EXPECT_THAT(refusal("(-1.000000) can0 457#01"), says("time is '-1.000000'"));
    EXPECT_THAT(refusal("(1700000000) can0 457#01"), says("with 6 or 9 decimals"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 45#01"), says("id is '45', must be 3 hex"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 45G#01"), says("id is '45G'"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 800#01"), says("must be at most 7FF"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 40000000#01"), says("id is '40000000'"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 A0000000#01"), says("id is 'A0000000'"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 457#0"), says("0 to 8 whole bytes"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 457#0X"), says("data is '0X', must be hex"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 457#001122334455667788"), says("0 to 8 whole"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 457#R9"), says("data is 'R9', must be hex"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 457#R88"), says("R or R0 to R8"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 457##"), says("one hex digit"));
    EXPECT_THAT(refusal("(1700000000.000000) can0 457##0" + std::string(18, '0')), says("of FD"));
    EXPECT_THAT(refusal("(1700000000.000000) can1 457#01"),
                says("interface is 'can1', must be can0 as in line 1"));
    EXPECT_EQ(Refusal(good + good), "");
}

TEST_F(CandumpCanBusTest, ABadLineIsFoundWhereverItStands) {
    std::string text;
    for (int i = 0; i < 1000; ++i) text += "(1700000000.000000) can0 457#01\n";
    EXPECT_THAT(Refusal(text + "x\n"), HasSubstr(path_ + ":1001: "));
}

TEST_F(CandumpCanBusTest, AFileThatIsNotThereIsNamed) {
    const auto bus = CandumpCanBus::Open(folder_ / "none.log", kStart);
    ASSERT_FALSE(bus);
    EXPECT_THAT(bus.error(), HasSubstr("none.log: No such file"));
}

TEST_F(CandumpCanBusTest, AFileOverTheLargestSizeIsRefusedUnread) {
    std::filesystem::resize_file(Write("x"), CandumpCanBus::kMaxBytes + 1);
    const auto bus = CandumpCanBus::Open(path_, kStart);
    ASSERT_FALSE(bus);
    EXPECT_THAT(bus.error(), HasSubstr("has 67108865 bytes, must be at most 67108864"));
}

TEST_F(CandumpCanBusTest, ReadingTakesNoMemory) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    std::string text;
    for (int i = 0; i < 100; ++i) {
        text += "(1700000000.000000) can0 457##0" + std::string(128, '7') +
                "\n(1700000000.000000) can0 457#R\n";
    }
    const auto bus = Open(text);
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    int frames = 0;
    while (bus->WaitFrame(kTimeout)) ++frames;
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
    EXPECT_EQ(frames, 100);
}

}  // namespace
}  // namespace hitchview::drivers
