#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/web_state.hpp"
#include "tests/support/rig_messages.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;
using nlohmann::json;
using std::chrono::milliseconds;
using tests::MessageBytes;

constexpr Instant kStart = std::chrono::seconds(100);
const MessageBytes kJpeg{0xFF, 0xD8, 0xFF, 0xE0, 0xFF, 0xD9};
const std::vector<std::string> kNames{"front", "left", "rear"};

/// A state that hears messages, and a client of it.
class WebStateTest : public testing::Test {
 protected:
    void Hear(const std::string& channel, const MessageBytes& message,
              milliseconds after = milliseconds(0)) {
        state_.Take(channel, message, kStart + after);
    }
    json News(milliseconds after = milliseconds(0)) {
        return json::parse(state_.News(cursor_, kStart + after));
    }
    std::string StateOf(std::size_t camera, milliseconds after = milliseconds(0)) {
        return News(after)["cameras"].at(camera)["state"];
    }

    WebState state_{WebChannels{}};
    WebState::Cursor cursor_{};
};

TEST_F(WebStateTest, NothingHeardIsNothingTold) {
    const json news = News();
    EXPECT_TRUE(news["panorama"].is_null());
    EXPECT_TRUE(news["status"].is_null());
    EXPECT_TRUE(news["status_age_ms"].is_null());
    EXPECT_TRUE(news["cameras"].empty());
}

TEST_F(WebStateTest, AMissingCameraIsLostAndWithSilenceUnknown) {
    Hear("PANORAMA_HEALTH", tests::HealthBytes(0, {.cameras = kNames}));
    Hear("PANORAMA_STATUS", tests::StatusBytes(1, 1000, 0b010));
    EXPECT_EQ(StateOf(0), "live");
    EXPECT_EQ(StateOf(1), "lost");
    EXPECT_EQ(StateOf(0, milliseconds(1100)), "unknown");
    EXPECT_EQ(StateOf(0, milliseconds(4000)), "unknown");
}

TEST_F(WebStateTest, EachKindOfMessageMayBeTheFirstToTellThatACameraIsLost) {
    const auto all_live = [&](milliseconds at) {
        Hear("PANORAMA_HEALTH", tests::HealthBytes(0, {.cameras = kNames}), at);
        Hear("PANORAMA_STATUS", tests::StatusBytes(1, 1000, 0), at);
    };
    all_live(milliseconds(0));
    Hear("PANORAMA_EVENT", tests::EventBytes(0, 1, "left", "no frame"));
    EXPECT_EQ(StateOf(1), "lost");
    Hear("PANORAMA_EVENT", tests::EventBytes(1, 2, "left", "after 1 s"));
    EXPECT_EQ(StateOf(1), "live");
    Hear("PANORAMA_HEALTH", tests::HealthBytes(1, {.cameras = kNames, .missing = 0b100}));
    EXPECT_EQ(StateOf(2), "lost");
    all_live(milliseconds(100));
    EXPECT_EQ(StateOf(2, milliseconds(100)), "live");
}

TEST_F(WebStateTest, ALostCameraWhoseReturnWasNotHeardIsLiveWhenTheStatusSaysSoForLong) {
    Hear("PANORAMA_HEALTH", tests::HealthBytes(0, {.cameras = kNames}));
    Hear("PANORAMA_EVENT", tests::EventBytes(0, 1, "left", "no frame"));
    Hear("PANORAMA_STATUS", tests::StatusBytes(1, 1000, 0), milliseconds(2000));
    EXPECT_EQ(StateOf(1, milliseconds(2000)), "lost");
    Hear("PANORAMA_STATUS", tests::StatusBytes(2, 1000, 0), milliseconds(3100));
    EXPECT_EQ(StateOf(1, milliseconds(3100)), "live");
}

TEST_F(WebStateTest, AMissingCameraThatNobodyNamedGetsANumber) {
    Hear("PANORAMA_STATUS", tests::StatusBytes(1, 1000, 0b100));
    const json cameras = News()["cameras"];
    ASSERT_EQ(cameras.size(), 3U);
    EXPECT_EQ(cameras[2]["name"], "camera 3");
    EXPECT_EQ(cameras[2]["state"], "lost");
}

TEST_F(WebStateTest, AClientIsToldEachSampleAndEachEventOnce) {
    Hear("PANORAMA_STATUS", tests::StatusBytes(1, 1000, 0, 20, 0.5));
    Hear("PANORAMA_STATUS", tests::StatusBytes(2, 2000, 0, 30), milliseconds(33));
    Hear("PANORAMA_EVENT", tests::EventBytes(0, 40, "rig", "first"));
    const json first = News(milliseconds(40));
    ASSERT_EQ(first["traces"]["status"].size(), 2U);
    EXPECT_EQ(first["traces"]["status"][0], (json{100'000, 20.0, 14.0, 28.65}));
    ASSERT_EQ(first["events"].size(), 1U);
    Hear("PANORAMA_EVENT", tests::EventBytes(1, 40, "rig", "second"));
    const json second = News(milliseconds(50));
    EXPECT_TRUE(second["traces"]["status"].empty());
    ASSERT_EQ(second["events"].size(), 1U);
    EXPECT_EQ(second["events"][0]["text"], "second");
    WebState::Cursor other;
    EXPECT_EQ(json::parse(state_.News(other, kStart))["events"].size(), 2U);
}

TEST_F(WebStateTest, AClientThatWasAwayForLongIsToldAMinuteAndNoMore) {
    for (std::uint32_t i = 0; i < 5000; ++i) {
        Hear("PANORAMA_STATUS", tests::StatusBytes(i, 1000, 0), milliseconds(33 * i));
        Hear("HITCH_ANGLE", tests::HitchAngleBytes(i, 0.1), milliseconds(33 * i));
        Hear("PANORAMA_EVENT", tests::EventBytes(i, 40, "rig", "text"), milliseconds(33 * i));
    }
    const json news = News(milliseconds(165'000));
    EXPECT_EQ(news["traces"]["status"].size(), 1800U);
    EXPECT_LE(news["traces"]["hitch_angle"].size(), 1200U);
    EXPECT_EQ(news["events"].size(), 200U);
    EXPECT_EQ(news["events"].back()["number"], 5000);
}

TEST_F(WebStateTest, AnAngleThatIsNotValidIsNoNumber) {
    Hear("HITCH_ANGLE", tests::HitchAngleBytes(0, 0.1, 2));
    const json news = News();
    EXPECT_EQ(news["hitch_angle"]["quality"], "sensor error");
    EXPECT_TRUE(news["hitch_angle"]["angle_deg"].is_null());
    EXPECT_TRUE(news["traces"]["hitch_angle"][0][1].is_null());
}

TEST_F(WebStateTest, HealthIsToldWhenItIsNew) {
    Hear("PANORAMA_HEALTH",
         tests::HealthBytes(7, {.cameras = kNames, .warning = "raise rmem_max"}));
    const json news = News();
    EXPECT_EQ(news["health"]["warning"], "raise rmem_max");
    EXPECT_EQ(news["health"]["stages"].size(), 7U);
    EXPECT_EQ(news["cameras"][0]["name"], "front");
    EXPECT_EQ(news["cameras"][0]["unit"], "tractor");
    EXPECT_FALSE(News().contains("health"));
}

TEST_F(WebStateTest, TextThatIsNotUtf8IsReplacedAndStaysOneLine) {
    Hear("PANORAMA_EVENT", tests::EventBytes(0, 40, "\xFF\xFE", "a\nb\r\n\ndata: c</script>"));
    WebState::Cursor cursor;
    const std::string line = state_.News(cursor, kStart);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(json::parse(line)["events"][0]["text"], "a\nb\r\n\ndata: c</script>");
}

TEST_F(WebStateTest, DamagedMessagesAreCountedAndChangeNothing) {
    for (const char* channel : {"PANORAMA", "PANORAMA_STATUS", "PANORAMA_EVENT", "HITCH_ANGLE",
                                "PANORAMA_HEALTH", "PANORAMA_OVERLAY", "PREVIEW_FRONT", "OTHER"}) {
        Hear(channel, {1, 2, 3});
    }
    EXPECT_EQ(state_.refused(), 8U);
    EXPECT_TRUE(News()["panorama"].is_null());
    EXPECT_FALSE(state_.TakeUrgency());
}

TEST_F(WebStateTest, AnEventAndAnotherSetOfCamerasAreUrgent) {
    Hear("PANORAMA_STATUS", tests::StatusBytes(1, 1000, 0));
    EXPECT_FALSE(state_.TakeUrgency());
    Hear("PANORAMA_STATUS", tests::StatusBytes(2, 2000, 1));
    EXPECT_TRUE(state_.TakeUrgency());
    EXPECT_FALSE(state_.TakeUrgency());
    Hear("PANORAMA_EVENT", tests::EventBytes(1, 40, "rig", "text"));
    EXPECT_TRUE(state_.TakeUrgency());
}

TEST_F(WebStateTest, APanoramaThatComesAgainIsNotANewOne) {
    const MessageBytes image = tests::ImageBytes(kJpeg, 64, 32, 7, 1000);
    Hear("PANORAMA", image);
    Hear("PANORAMA", image, milliseconds(400));
    EXPECT_EQ(state_.pictures().panorama().serial, 1U);
    EXPECT_EQ(News(milliseconds(400))["panorama"]["age_ms"], 400.0);
    Hear("PANORAMA", tests::ImageBytes(kJpeg, 64, 32, 8, 2000), milliseconds(433));
    EXPECT_EQ(state_.pictures().panorama().serial, 2U);
}

TEST_F(WebStateTest, PicturesThatClientsHoldAreBounded) {
    MessageBytes large(2 << 20, 0);
    large[0] = 0xFF;
    large[1] = 0xD8;
    std::vector<WebBytes> held;
    for (std::uint32_t i = 0; i < 100; ++i) {
        Hear("PANORAMA", tests::ImageBytes(large, 64, 32, i, i));
        held.push_back(state_.pictures().panorama().jpeg);
    }
    EXPECT_EQ(state_.pictures().HeldBytes(), WebPictures::kMostHeldBytes);
    EXPECT_EQ(state_.pictures().panorama().sequence, 31U);
    held.clear();
    Hear("PANORAMA", tests::ImageBytes(large, 64, 32, 100, 100));
    EXPECT_EQ(state_.pictures().panorama().sequence, 100U);
}

TEST_F(WebStateTest, ThumbnailsAreGivenBehindTheOnesThatAClientHasAndNotWhenTheyAreOld) {
    Hear("PREVIEW_FRONT", tests::ImageBytes(kJpeg, 192, 108, 1, 1));
    Hear("PREVIEW_LEFT", tests::ImageBytes(kJpeg, 192, 108, 1, 1));
    const std::size_t left_bytes = 1 + 4 + 8 + kJpeg.size();
    const auto pictures = state_.pictures().PreviewsAfter(1, kStart + milliseconds(20));
    ASSERT_EQ(pictures.size(), left_bytes);
    EXPECT_EQ(std::string(pictures.begin(), pictures.begin() + 5), "\4LEFT");
    EXPECT_EQ(pictures.at(8), 20);
    EXPECT_EQ(pictures.at(12), kJpeg.size());
    EXPECT_TRUE(state_.pictures().PreviewsAfter(0, kStart + milliseconds(4000)).empty());
    for (int i = 0; i < 100; ++i) {
        Hear("PREVIEW_" + std::to_string(i), tests::ImageBytes(kJpeg, 192, 108, 1, 1));
    }
    EXPECT_EQ(state_.pictures().newest_preview(), WebPictures::kMostPreviews);
}

TEST_F(WebStateTest, AnOverlayIsToldInWholePixelsAndNullWhereThereIsNone) {
    Hear("PANORAMA_OVERLAY", tests::OverlayBytes(3, 2048, 360, 0));
    EXPECT_EQ(state_.overlay_serial(), 1U);
    const json overlay = json::parse(state_.overlay());
    EXPECT_EQ(overlay["mesh_x"].size(), 2U * 7 * 13);
    EXPECT_EQ(overlay["mesh_x"][0], 41.0);
    EXPECT_EQ(overlay["seam_y"].size(), 21U);
}

}  // namespace
}  // namespace hitchview::app
