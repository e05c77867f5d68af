#include <gtest/gtest.h>

#include <cmath>

#include "drivers/lcm_logged_health.hpp"
#include "drivers/lcm_logged_overlay.hpp"
#include "tests/support/rig_messages.hpp"

namespace hitchview::drivers {
namespace {

using tests::MessageBytes;

const std::vector<std::string> kNames{"front", "left"};

/// Overwrites the four bytes at `at` with a big-endian number.
MessageBytes With(MessageBytes bytes, std::size_t at, std::int32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
        bytes.at(at + i) = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    }
    return bytes;
}

TEST(LcmHealthMessageTest, WhatLcmGenWritesIsReadBack) {
    const MessageBytes bytes =
        tests::HealthBytes(7, {.cameras = kNames, .missing = 2, .warning = "hot"});
    const auto health = ParseLoggedHealth(bytes);
    ASSERT_TRUE(health);
    EXPECT_EQ(health.value().sequence, 7U);
    EXPECT_EQ(health.value().version, "0.1.0");
    EXPECT_EQ(health.value().warning, "hot");
    EXPECT_EQ(health.value().image_bytes, 142'000);
    EXPECT_EQ(health.value().disk_free_bytes, 412'000'000'000);
    EXPECT_EQ(health.value().recording, HITCHVIEW_HEALTH_T_RECORDING_ON);
    ASSERT_EQ(health.value().cameras.size(), 2U);
    EXPECT_EQ(health.value().cameras[1].name, "left");
    EXPECT_FALSE(health.value().cameras[1].shown);
    EXPECT_EQ(health.value().cameras[0].frames_per_s, 30.0);
    ASSERT_EQ(health.value().stages.size(), 7U);
    EXPECT_EQ(health.value().stages[6].name, "latency");
    EXPECT_EQ(health.value().stages[6].max_ms, 38.0);
}

TEST(LcmHealthMessageTest, ACutMessageIsRefusedWhereverItIsCut) {
    const MessageBytes bytes = tests::HealthBytes(7, {.cameras = kNames});
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_FALSE(ParseLoggedHealth(std::span(bytes).first(size))) << size;
    }
    MessageBytes longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(ParseLoggedHealth(longer));
}

TEST(LcmHealthMessageTest, CountsAndTextsBeyondReasonAreRefused) {
    const MessageBytes none = tests::HealthBytes(7, {});
    // At the end: the count of cameras, that of stages, and seven stages of a name and four times.
    const std::size_t names_bytes =
        7 * 5 + std::string("motionmaprendertotaljpegsendlatency").size();
    const std::size_t count_at = none.size() - 4 - 4 - 7 * 4 * 8 - names_bytes;
    ASSERT_TRUE(ParseLoggedHealth(With(none, count_at, 0)));
    EXPECT_FALSE(ParseLoggedHealth(With(none, count_at, -1)));
    EXPECT_FALSE(ParseLoggedHealth(With(none, count_at, INT32_MAX)));
    EXPECT_FALSE(ParseLoggedHealth(With(none, count_at + 4, kMostHealthStages + 1)));
    const std::string text(kMostHealthTextBytes + 1, 'a');
    EXPECT_FALSE(ParseLoggedHealth(tests::HealthBytes(7, {.warning = text})));
    EXPECT_FALSE(ParseLoggedHealth(
        tests::HealthBytes(7, {.cameras = std::vector<std::string>(33, "front")})));
    EXPECT_TRUE(ParseLoggedHealth(
        tests::HealthBytes(7, {.cameras = std::vector<std::string>(32, "front")})));
}

TEST(LcmOverlayMessageTest, WhatLcmGenWritesIsReadBack) {
    const auto overlay = ParseLoggedOverlay(tests::OverlayBytes(9, 2048, 360, 0));
    ASSERT_TRUE(overlay);
    EXPECT_EQ(overlay.value().sequence, 9U);
    EXPECT_EQ(overlay.value().width_px, 2048);
    EXPECT_EQ(overlay.value().mesh_rows, 7);
    EXPECT_EQ(overlay.value().mesh_columns, 13);
    ASSERT_EQ(overlay.value().mesh_x_px.size(), 2U * 7 * 13);
    EXPECT_FLOAT_EQ(overlay.value().mesh_x_px[12], 0.46F * 2048);
    ASSERT_EQ(overlay.value().left_seam_x_px.size(), 21U);
    EXPECT_FLOAT_EQ(overlay.value().seam_y_px[20], 360);
    EXPECT_FLOAT_EQ(overlay.value().right_seam_x_px[0], 2048 * 0.76F);
}

TEST(LcmOverlayMessageTest, ACutMessageIsRefusedWhereverItIsCut) {
    const MessageBytes bytes = tests::OverlayBytes(9, 2048, 360, 0);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_FALSE(ParseLoggedOverlay(std::span(bytes).first(size))) << size;
    }
}

TEST(LcmOverlayMessageTest, CountsThatDoNotFitEachOtherAreRefused) {
    const MessageBytes bytes = tests::OverlayBytes(9, 2048, 360, 0);
    constexpr std::size_t kWidthAt = 8 + 4 + 8 + 8;
    constexpr std::size_t kRowsAt = kWidthAt + 8;
    ASSERT_TRUE(ParseLoggedOverlay(With(bytes, kRowsAt, 7)));
    for (const std::int32_t rows : {-7, 0, 8, kMostOverlayRows + 1, INT32_MAX, INT32_MIN}) {
        EXPECT_FALSE(ParseLoggedOverlay(With(bytes, kRowsAt, rows))) << rows;
    }
    EXPECT_FALSE(ParseLoggedOverlay(With(bytes, kRowsAt + 8, -1)));
    for (const std::int32_t width : {0, -1, 16385}) {
        EXPECT_FALSE(ParseLoggedOverlay(With(bytes, kWidthAt, width))) << width;
    }
}

}  // namespace
}  // namespace hitchview::drivers
