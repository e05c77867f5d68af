#include <gtest/gtest.h>

#include "drivers/lcm_log_camera.hpp"
#include "drivers/lcm_log_can_bus.hpp"
#include "drivers/lcm_log_reader.hpp"
#include "tests/support/log_messages.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;

constexpr int kWidth = 32;
constexpr int kHeight = 16;
constexpr milliseconds kPatience{20};

class LcmLogCameraTest : public testing::Test {
 protected:
    /// A log of grey pictures: picture i is all i. Where their messages are.
    std::vector<LcmLogPlace> WriteLog(int pictures) {
        tests::MessageLog log(file_);
        for (int i = 0; i < pictures; ++i) {
            log.Picture("CAM_A", {.width_px = kWidth,
                                  .height_px = kHeight,
                                  .fourcc = BOT_CORE_IMAGE_T_PIXEL_FORMAT_GRAY,
                                  .data = std::vector<std::uint8_t>(kWidth * kHeight,
                                                                    static_cast<std::uint8_t>(i))});
        }
        std::vector<LcmLogPlace> places;
        const auto reader = std::move(*LcmLogReader::Open(file_));
        while (const auto event = reader->Next()) {
            const auto& e = event.value();
            places.push_back(
                {.position_bytes = e.position_bytes + kLcmLogHeaderBytes + e.channel.size(),
                 .size_bytes = static_cast<std::uint32_t>(e.data.size())});
        }
        return places;
    }

    [[nodiscard]] LcmLogCameraOptions Options(int slots = 4) const {
        return {.files = {file_},
                .kind = {.format = {kWidth, kHeight, hal::PixelFormat::kGrey, hal::Range::kFull}},
                .slots = slots};
    }

    tests::TemporaryFolder folder_;
    std::string file_ = folder_ / "log.lcm";
};

TEST_F(LcmLogCameraTest, GivesTheFramesThatAreWantedAndThenEnds) {
    const auto places = WriteLog(3);
    LcmLogCamera camera(Options());
    EXPECT_EQ(camera.WaitFrame(kPatience).error(), hal::Error::kTimeout);
    for (const std::uint32_t wanted : {2U, 0U}) {
        const hal::FrameHeader header{wanted, milliseconds(wanted)};
        ASSERT_TRUE(camera.Append(header, places[wanted]));
        const auto frame = camera.WaitFrame(kPatience);
        ASSERT_TRUE(frame.ok());
        EXPECT_EQ(frame.value().view().header.sequence, wanted);
        EXPECT_EQ(frame.value().view().planes[0].data[kWidth * kHeight - 1], wanted);
    }
    camera.Close();
    EXPECT_EQ(camera.WaitFrame(kPatience).error(), hal::Error::kEndOfStream);
    EXPECT_FALSE(camera.Append({}, places[0]));
}

TEST_F(LcmLogCameraTest, WhatIsNotThereIsDamaged) {
    const auto places = WriteLog(2);
    LcmLogCamera camera(Options());
    LcmLogPlace shifted = places[0];
    shifted.position_bytes += 1;
    LcmLogPlace endless = places[0];
    endless.size_bytes = 0xFFFFFFFF;
    LcmLogPlace behind = places[1];
    behind.position_bytes += 1;
    LcmLogPlace elsewhere = places[0];
    elsewhere.file = 7;
    for (const LcmLogPlace& place : {shifted, endless, behind, elsewhere}) {
        ASSERT_TRUE(camera.Append({}, place));
        EXPECT_EQ(camera.WaitFrame(kPatience).error(), hal::Error::kCorrupted);
    }
    ASSERT_TRUE(camera.Append({}, places[1]));
    EXPECT_TRUE(camera.WaitFrame(kPatience).ok());
    EXPECT_EQ(camera.pool().slots, 4);
}

TEST_F(LcmLogCameraTest, WithoutAFreeFrameNothingIsLost) {
    const auto places = WriteLog(2);
    LcmLogCamera camera(Options(1));
    for (const LcmLogPlace& place : places) ASSERT_TRUE(camera.Append({}, place));
    {
        const auto lent = camera.WaitFrame(kPatience);
        ASSERT_TRUE(lent.ok());
        EXPECT_EQ(camera.WaitFrame(kPatience).error(), hal::Error::kTimeout);
    }
    EXPECT_TRUE(camera.WaitFrame(kPatience).ok());
}

TEST(LcmLogCanBusTest, NeverMakesTheReaderWait) {
    LcmLogCanBus bus;
    constexpr std::uint32_t kFrames = LcmLogCanBus::kMostWaiting + 10;
    for (std::uint32_t i = 0; i < kFrames; ++i) bus.Append({.id = i});
    bus.Close();
    std::uint32_t taken = 0;
    while (const auto frame = bus.WaitFrame(kPatience)) EXPECT_EQ(frame.value().id, taken++);
    EXPECT_EQ(taken, LcmLogCanBus::kMostWaiting);
    EXPECT_EQ(bus.counts().delivered, LcmLogCanBus::kMostWaiting);
    EXPECT_EQ(bus.counts().dropped, 10U);
    EXPECT_EQ(bus.WaitFrame(kPatience).error(), hal::Error::kEndOfStream);
}

}  // namespace
}  // namespace hitchview::drivers
