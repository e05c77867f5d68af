#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <cmath>
#include <string>

#include "drivers/lcm_publisher.hpp"
#include "drivers/lcm_subscriber.hpp"
#include "hal/fake_clock.hpp"
#include "lcmtypes/bot_core_image_t.h"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_health_t.h"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "lcmtypes/hitchview_overlay_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"

namespace hitchview::drivers {
namespace {

using hal::Error;
using hal::Instant;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// LCM writes to a log file instead of the network.
class LcmPublisherTest : public testing::Test {
 protected:
    LcmPublisherTest() : log_(testing::TempDir() + TestName() + ".lcmlog") {}
    ~LcmPublisherTest() override { std::remove(log_.c_str()); }

    std::unique_ptr<LcmPublisher> Publisher(int max_image_bytes = 4096) const {
        auto publisher = LcmPublisher::Create(
            {.url = "file://" + log_ + "?mode=w", .messages = {.max_image_bytes = max_image_bytes}},
            clock_);
        EXPECT_TRUE(publisher) << publisher.error();
        return std::move(publisher.value());
    }

    /// The only message of the log beside the one that tells of the start.
    template <typename Message>
    Message Read(const std::string& channel, int (*decode)(const void*, int, int, Message*)) const {
        Message message{};
        lcm_eventlog_t* const log = lcm_eventlog_create(log_.c_str(), "r");
        lcm_eventlog_event_t* const start = lcm_eventlog_read_next_event(log);
        EXPECT_EQ(std::string(start->channel, start->channellen), kLcmStartChannel);
        EXPECT_EQ(start->datalen, 0);
        lcm_eventlog_free_event(start);
        lcm_eventlog_event_t* const event = lcm_eventlog_read_next_event(log);
        EXPECT_EQ(std::string(event->channel, event->channellen), channel);
        EXPECT_EQ(decode(event->data, 0, event->datalen, &message), event->datalen);
        EXPECT_EQ(lcm_eventlog_read_next_event(log), nullptr);
        lcm_eventlog_free_event(event);
        lcm_eventlog_destroy(log);
        return message;
    }

    std::string log_;
    hal::FakeClock clock_;

 private:
    static std::string TestName() {
        return testing::UnitTest::GetInstance()->current_test_info()->name();
    }
};

const std::vector<std::uint8_t> kJpeg{0xFF, 0xD8, 1, 2, 3, 0xFF, 0xD9};

hal::PanoramaImage Image(std::span<const std::uint8_t> jpeg) {
    return {.sequence = 4'000'000'000,
            .captured_from = milliseconds(20),
            .captured_until = milliseconds(25),
            .width_px = 2048,
            .height_px = 360,
            .cameras_missing = 0x81,
            .calibration_id = "5f3c",
            .jpeg = jpeg};
}

std::string Text(const bot_core_image_metadata_t& entry) {
    return std::string(entry.key) + '=' + std::string(entry.value, entry.value + entry.n);
}

TEST_F(LcmPublisherTest, APanoramaIsAnImageOfLibbotWithItsPropertiesAsText) {
    ASSERT_TRUE(Publisher()->Publish(Image(kJpeg)));

    auto message = Read("PANORAMA", bot_core_image_t_decode);
    EXPECT_EQ(message.utime, 1'700'000'000'020'000);
    EXPECT_EQ(message.width, 2048);
    EXPECT_EQ(message.height, 360);
    EXPECT_EQ(message.row_stride, 0);
    EXPECT_EQ(message.pixelformat, BOT_CORE_IMAGE_T_PIXEL_FORMAT_MJPEG);
    EXPECT_EQ(std::vector<std::uint8_t>(message.data, message.data + message.size), kJpeg);
    ASSERT_EQ(message.nmetadata, 5);
    EXPECT_EQ(Text(message.metadata[0]), "sequence=4000000000");
    EXPECT_EQ(Text(message.metadata[1]), "captured_from_ns=20000000");
    EXPECT_EQ(Text(message.metadata[2]), "captured_until_ns=25000000");
    EXPECT_EQ(Text(message.metadata[3]), "cameras_missing=0x00000081");
    EXPECT_EQ(Text(message.metadata[4]), "calibration_id=5f3c");
    bot_core_image_t_decode_cleanup(&message);
}

TEST_F(LcmPublisherTest, OurSubscriberReadsWhatWasPublished) {
    ASSERT_TRUE(Publisher()->Publish(Image(kJpeg)));

    auto subscriber = LcmSubscriber::Create({.url = "file://" + log_ + "?mode=r&speed=0"});
    ASSERT_TRUE(subscriber) << subscriber.error();
    // The message of the start comes first and is not for this subscriber.
    EXPECT_EQ(subscriber.value()->WaitImage(milliseconds(1000)).error(), Error::kTimeout);
    const auto result = subscriber.value()->WaitImage(milliseconds(1000));
    ASSERT_TRUE(result) << ToString(result.error());
    const hal::PanoramaImage& image = result.value();
    EXPECT_EQ(image.sequence, 4'000'000'000U);
    EXPECT_EQ(image.captured_from, milliseconds(20));
    EXPECT_EQ(image.captured_until, milliseconds(25));
    EXPECT_EQ(image.cameras_missing, 0x81U);
    EXPECT_EQ(image.calibration_id, "5f3c");
    EXPECT_EQ(std::vector<std::uint8_t>(image.jpeg.begin(), image.jpeg.end()), kJpeg);
    EXPECT_EQ(subscriber.value()->received(), 1U);
}

TEST_F(LcmPublisherTest, TheLargestImageFitsAndOneByteMoreDoesNot) {
    const auto publisher = Publisher(4096);
    const std::vector<std::uint8_t> jpeg(4097, 7);

    const auto too_large = publisher->Publish(Image(jpeg));
    ASSERT_FALSE(too_large);
    EXPECT_EQ(too_large.error(), Error::kTooLarge);
    EXPECT_TRUE(publisher->Publish(Image(std::span(jpeg).first(4096))));
}

TEST_F(LcmPublisherTest, ACalibrationIdThatDoesNotFitIsTooLarge) {
    const std::string id(2000, 'x');
    hal::PanoramaImage image = Image(std::vector<std::uint8_t>(4096, 7));
    const std::vector<std::uint8_t> jpeg(4096, 7);
    image.jpeg = jpeg;
    image.calibration_id = id;

    const auto result = Publisher(4096)->Publish(image);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error(), Error::kTooLarge);
}

TEST_F(LcmPublisherTest, AStatusKeepsEveryField) {
    ASSERT_TRUE(Publisher()->Publish(
        hal::PanoramaStatus{.sequence = 9,
                            .captured_from = milliseconds(30),
                            .published_at = milliseconds(70),
                            .spread = milliseconds(12),
                            .cameras_missing = 2,
                            .seams = {hal::SeamState::kLocked, hal::SeamState::kCoast},
                            .seam_matches = {41, 3},
                            .unit_features = {300, 280},
                            .total_ms = 12.5,
                            .deadline_misses = 6,
                            .dropped = 1,
                            .articulation_rad = -0.25,
                            .articulation_sigma_rad = 0.004}));

    const auto message = Read("PANORAMA_STATUS", hitchview_panorama_status_t_decode);
    EXPECT_EQ(message.sequence, 9);
    EXPECT_EQ(message.utime, 1'700'000'000'030'000);
    EXPECT_EQ(message.capture_ns, 30'000'000);
    EXPECT_EQ(message.publish_ns, 70'000'000);
    EXPECT_EQ(message.spread_ns, 12'000'000);
    EXPECT_EQ(message.cameras_missing, 2);
    EXPECT_EQ(message.seam_state[0], HITCHVIEW_PANORAMA_STATUS_T_SEAM_LOCKED);
    EXPECT_EQ(message.seam_state[1], HITCHVIEW_PANORAMA_STATUS_T_SEAM_COAST);
    EXPECT_EQ(message.seam_matches[0], 41);
    EXPECT_EQ(message.seam_matches[1], 3);
    EXPECT_EQ(message.unit_features[0], 300);
    EXPECT_EQ(message.unit_features[1], 280);
    EXPECT_EQ(message.total_ms, 12.5);
    EXPECT_EQ(message.deadline_misses, 6);
    EXPECT_EQ(message.dropped, 1);
    EXPECT_EQ(message.articulation_rad, -0.25);
    EXPECT_EQ(message.articulation_sigma_rad, 0.004);
}

TEST_F(LcmPublisherTest, AnArticulationThatIsNotKnownIsNotANumber) {
    ASSERT_TRUE(Publisher()->Publish(hal::PanoramaStatus{.sequence = 9}));

    const auto message = Read("PANORAMA_STATUS", hitchview_panorama_status_t_decode);
    EXPECT_TRUE(std::isnan(message.articulation_rad));
    EXPECT_TRUE(std::isnan(message.articulation_sigma_rad));
}

TEST_F(LcmPublisherTest, AValidHitchAngleIsSentWithItsMoment) {
    ASSERT_TRUE(Publisher()->Publish(hal::HitchAngle{.angle_rad = -0.3,
                                                     .quality = hal::HitchAngleQuality::kValid,
                                                     .received_at = milliseconds(5)}));

    const auto message = Read("HITCH_ANGLE", hitchview_hitch_angle_t_decode);
    EXPECT_EQ(message.sequence, 0);
    EXPECT_EQ(message.utime, 1'700'000'000'005'000);
    EXPECT_EQ(message.capture_ns, 5'000'000);
    EXPECT_EQ(message.valid, 1);
    EXPECT_EQ(message.quality, HITCHVIEW_HITCH_ANGLE_T_QUALITY_VALID);
    EXPECT_EQ(message.angle_rad, -0.3);
}

TEST_F(LcmPublisherTest, AHitchAngleThatIsNotValidIsNotANumber) {
    ASSERT_TRUE(Publisher()->Publish(
        hal::HitchAngle{.angle_rad = 0.1, .quality = hal::HitchAngleQuality::kError}));

    const auto message = Read("HITCH_ANGLE", hitchview_hitch_angle_t_decode);
    EXPECT_EQ(message.valid, 0);
    EXPECT_EQ(message.quality, HITCHVIEW_HITCH_ANGLE_T_QUALITY_ERROR);
    EXPECT_TRUE(std::isnan(message.angle_rad));
}

TEST_F(LcmPublisherTest, AnEventKeepsEveryField) {
    ASSERT_TRUE(Publisher()->Publish(hal::Event{.code = hal::EventCode::kCameraBack,
                                                .when = milliseconds(5),
                                                .subject = std::string_view("rear"),
                                                .text = std::string_view("back after 412 ms")}));

    auto message = Read("PANORAMA_EVENT", hitchview_event_t_decode);
    EXPECT_EQ(message.sequence, 0);
    EXPECT_EQ(message.utime, 1'700'000'000'005'000);
    EXPECT_EQ(message.monotonic_ns, 5'000'000);
    EXPECT_EQ(message.code, HITCHVIEW_EVENT_T_CAMERA_BACK);
    EXPECT_STREQ(message.subject, "rear");
    EXPECT_STREQ(message.text, "back after 412 ms");
    hitchview_event_t_decode_cleanup(&message);
}

hal::Health FullHealth() {
    hal::Health health{.measured_at = milliseconds(5),
                       .version = std::string_view("1.2.3"),
                       .calibration_id = std::string_view("5f3c"),
                       .uptime_s = 12.5,
                       .panoramas_per_s = 30,
                       .panoramas = 375,
                       .dropped = 4,
                       .deadline_misses = 6,
                       .events_lost = 1,
                       .image_bytes = 98'000,
                       .image_budget_bytes = 150'000,
                       .image_quality = 71,
                       .receive_buffer_bytes = 212'992,
                       .warning = std::string_view("put this right"),
                       .rss_bytes = 123'456'789,
                       .minor_faults = 7,
                       .major_faults = 2,
                       .heap_calls = 0,
                       .recording = {hal::RecordingState::kOn, 1'000'000, 3, 5'000'000}};
    health.cameras.Add({.name = std::string_view("front"),
                        .unit = std::string_view("tractor"),
                        .shown = true,
                        .state = hal::CameraState::kDirty,
                        .frames_per_s = 29.5,
                        .age_ms = 41,
                        .delivered = 370,
                        .lost = 5,
                        .corrupted = 2,
                        .reopened = 1});
    health.stages.Add({std::string_view("motion"), 1, 2, 3, 4});
    health.stages.Add({std::string_view("total"), 5, 6, 7, 8});
    return health;
}

TEST_F(LcmPublisherTest, HealthKeepsEveryField) {
    ASSERT_TRUE(Publisher()->Publish(FullHealth()));

    auto message = Read("PANORAMA_HEALTH", hitchview_health_t_decode);
    EXPECT_EQ(message.sequence, 0);
    EXPECT_EQ(message.utime, 1'700'000'000'005'000);
    EXPECT_EQ(message.monotonic_ns, 5'000'000);
    EXPECT_STREQ(message.version, "1.2.3");
    EXPECT_STREQ(message.calibration_id, "5f3c");
    EXPECT_EQ(message.uptime_s, 12.5);
    EXPECT_EQ(message.panoramas_per_s, 30);
    EXPECT_EQ(message.panoramas, 375);
    EXPECT_EQ(message.dropped, 4);
    EXPECT_EQ(message.deadline_misses, 6);
    EXPECT_EQ(message.events_lost, 1);
    EXPECT_EQ(message.image_bytes, 98'000);
    EXPECT_EQ(message.image_budget_bytes, 150'000);
    EXPECT_EQ(message.image_quality, 71);
    EXPECT_EQ(message.receive_buffer_bytes, 212'992);
    EXPECT_STREQ(message.warning, "put this right");
    EXPECT_EQ(message.rss_bytes, 123'456'789);
    EXPECT_EQ(message.minor_faults, 7);
    EXPECT_EQ(message.major_faults, 2);
    EXPECT_EQ(message.heap_calls, 0);
    EXPECT_EQ(message.recording, HITCHVIEW_HEALTH_T_RECORDING_ON);
    EXPECT_EQ(message.recorded_bytes, 1'000'000);
    EXPECT_EQ(message.recording_dropped, 3);
    EXPECT_EQ(message.disk_free_bytes, 5'000'000);
    hitchview_health_t_decode_cleanup(&message);
}

TEST_F(LcmPublisherTest, HealthHasItsCamerasAndStages) {
    ASSERT_TRUE(Publisher()->Publish(FullHealth()));

    auto message = Read("PANORAMA_HEALTH", hitchview_health_t_decode);
    ASSERT_EQ(message.ncameras, 1);
    const hitchview_camera_health_t& camera = message.cameras[0];
    EXPECT_STREQ(camera.name, "front");
    EXPECT_STREQ(camera.unit, "tractor");
    EXPECT_EQ(camera.shown, 1);
    EXPECT_EQ(camera.frames_per_s, 29.5);
    EXPECT_EQ(camera.age_ms, 41);
    EXPECT_EQ(camera.delivered, 370);
    EXPECT_EQ(camera.lost, 5);
    EXPECT_EQ(camera.corrupted, 2);
    EXPECT_EQ(camera.reopened, 1);
    EXPECT_EQ(camera.state, HITCHVIEW_CAMERA_HEALTH_T_DIRTY);
    ASSERT_EQ(message.nstages, 2);
    EXPECT_STREQ(message.stages[0].name, "motion");
    EXPECT_STREQ(message.stages[1].name, "total");
    EXPECT_EQ(message.stages[1].last_ms, 5);
    EXPECT_EQ(message.stages[1].p50_ms, 6);
    EXPECT_EQ(message.stages[1].p99_ms, 7);
    EXPECT_EQ(message.stages[1].max_ms, 8);
    hitchview_health_t_decode_cleanup(&message);
}

TEST_F(LcmPublisherTest, TheLongestHealthFits) {
    const std::string word(300, 'w');
    hal::Health health{.version = std::string_view(word),
                       .calibration_id = std::string_view(word),
                       .warning = std::string_view(word)};
    for (int i = 0; i < 20; ++i) {
        health.cameras.Add({.name = std::string_view(word), .unit = std::string_view(word)});
        health.stages.Add({.name = std::string_view(word)});
    }
    ASSERT_TRUE(Publisher(1024)->Publish(health));

    auto message = Read("PANORAMA_HEALTH", hitchview_health_t_decode);
    EXPECT_EQ(message.ncameras, 8);
    EXPECT_EQ(message.nstages, 12);
    hitchview_health_t_decode_cleanup(&message);
}

TEST_F(LcmPublisherTest, AViewportIsAnImageWithThePanoramasProperties) {
    hal::ViewportImage viewport{.channel = "VIEW_REAR", .image = Image(kJpeg)};
    viewport.image.width_px = 340;
    ASSERT_TRUE(Publisher()->Publish(viewport));

    auto message = Read("VIEW_REAR", bot_core_image_t_decode);
    EXPECT_EQ(message.width, 340);
    ASSERT_EQ(message.nmetadata, 5);
    EXPECT_EQ(Text(message.metadata[0]), "sequence=4000000000");
    EXPECT_EQ(Text(message.metadata[3]), "cameras_missing=0x00000081");
    bot_core_image_t_decode_cleanup(&message);
}

TEST_F(LcmPublisherTest, APreviewIsAnImageWithItsNumberAndMoment) {
    ASSERT_TRUE(Publisher()->Publish(hal::PreviewImage{.channel = "PREVIEW_REAR",
                                                       .sequence = 12,
                                                       .captured_at = milliseconds(20),
                                                       .width_px = 192,
                                                       .height_px = 108,
                                                       .jpeg = kJpeg}));

    auto message = Read("PREVIEW_REAR", bot_core_image_t_decode);
    EXPECT_EQ(message.utime, 1'700'000'000'020'000);
    EXPECT_EQ(message.width, 192);
    EXPECT_EQ(message.height, 108);
    EXPECT_EQ(std::vector<std::uint8_t>(message.data, message.data + message.size), kJpeg);
    ASSERT_EQ(message.nmetadata, 2);
    EXPECT_EQ(Text(message.metadata[0]), "sequence=12");
    EXPECT_EQ(Text(message.metadata[1]), "captured_ns=20000000");
    bot_core_image_t_decode_cleanup(&message);
}

TEST_F(LcmPublisherTest, AnOverlayKeepsEveryField) {
    const std::vector<float> x{1, 2, 3, 4};
    const std::vector<float> y{5, 6, 7, 8};
    const std::vector<float> rows{-0.5F, 7.5F, 15.5F};
    const std::vector<float> left{100, 101, 102};
    const std::vector<float> right{200, 201, 202};
    ASSERT_TRUE(Publisher()->Publish(hal::Overlay{.sequence = 9,
                                                  .captured_from = milliseconds(30),
                                                  .width_px = 2048,
                                                  .height_px = 360,
                                                  .mesh_rows = 1,
                                                  .mesh_cols = 2,
                                                  .mesh_x = x,
                                                  .mesh_y = y,
                                                  .seam_y = rows,
                                                  .left_seam_x = left,
                                                  .right_seam_x = right}));

    auto message = Read("PANORAMA_OVERLAY", hitchview_overlay_t_decode);
    const auto values = [](const float* first, int count) {
        return std::vector<float>(first, first + count);
    };
    EXPECT_EQ(message.sequence, 9);
    EXPECT_EQ(message.utime, 1'700'000'000'030'000);
    EXPECT_EQ(message.capture_ns, 30'000'000);
    EXPECT_EQ(message.width, 2048);
    EXPECT_EQ(message.height, 360);
    EXPECT_EQ(message.mesh_rows, 1);
    EXPECT_EQ(message.mesh_cols, 2);
    EXPECT_EQ(values(message.mesh_x, message.nvertices), x);
    EXPECT_EQ(values(message.mesh_y, message.nvertices), y);
    EXPECT_EQ(values(message.seam_y, message.seam_rows), rows);
    EXPECT_EQ(values(message.left_seam_x, message.seam_rows), left);
    EXPECT_EQ(values(message.right_seam_x, message.seam_rows), right);
    hitchview_overlay_t_decode_cleanup(&message);
}

TEST(LcmPublisherOptionsTest, AMistakeIsNamed) {
    const hal::FakeClock clock;
    const struct {
        LcmPublisherOptions options;
        const char* says;
    } cases[] = {
        {{.url = "udpm://1.2.3.4:5"}, "address is '1.2.3.4'"},
        {{.url = "file:///no/such/folder/drive.lcm?mode=w"}, "LCM cannot use 'file:///no/such"},
        {{.messages = {.panorama_channel = ".*"}}, "panorama_channel is '.*'"},
        {{.messages = {.status_channel = ""}}, "status_channel is ''"},
        {{.messages = {.hitch_angle_channel = "A B"}}, "hitch_angle_channel is 'A B'"},
        {{.messages = {.event_channel = "A/B"}}, "event_channel is 'A/B'"},
        {{.messages = {.health_channel = "A-B"}}, "health_channel is 'A-B'"},
        {{.messages = {.max_image_bytes = 100}}, "max_image_bytes is 100, must be 1024 to 8388608"},
    };
    for (const auto& c : cases) {
        const auto publisher = LcmPublisher::Create(c.options, clock);
        ASSERT_FALSE(publisher) << c.says;
        EXPECT_THAT(publisher.error(), HasSubstr(c.says));
    }
}

}  // namespace
}  // namespace hitchview::drivers
