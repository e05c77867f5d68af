#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/program.hpp"
#include "drivers/lcm_url.hpp"
#include "drivers/simulated_motion.hpp"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_health_t.h"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "lcmtypes/hitchview_overlay_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"
#include "tests/support/small_drive.hpp"
#include "tests/support/temporary_folder.hpp"

// `hitchview run` beside programs of other people. Runs in a network namespace of its own
// (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using std::chrono::milliseconds;
using tests::TemporaryFolder;

constexpr int kFrames = 90;
/// Frame sets that a busy machine may skip; with a sanitizer the count is not judged.
#ifdef HITCHVIEW_SANITIZED
constexpr int kMostDropped = kFrames;
#else
constexpr int kMostDropped = kFrames / 3;
#endif

/// bot_core_receiver as a child process.
class Receiver {
 public:
    explicit Receiver(int frames)
        : output_(popen((std::string(BOT_CORE_RECEIVER " '") + drivers::kDefaultLcmUrl +
                         "' PANORAMA " + std::to_string(frames) + " 12")
                            .c_str(),
                        "r")) {
        std::array<char, 256> line{};
        EXPECT_STREQ(std::fgets(line.data(), line.size(), output_), "ready\n");
    }
    ~Receiver() { pclose(output_); }
    Receiver(const Receiver&) = delete;
    Receiver& operator=(const Receiver&) = delete;

    struct Counts {
        int received = -1, missing = -1, undecodable = -1;
    };
    Counts Finish() {
        Counts counts;
        EXPECT_EQ(std::fscanf(output_, "received %d missing %d undecodable %d", &counts.received,
                              &counts.missing, &counts.undecodable),
                  3);
        return counts;
    }

 private:
    std::FILE* output_;
};

/// What lcm-logger wrote: messages by channel, in order.
std::map<std::string, std::vector<std::vector<std::uint8_t>>> ReadLog(const std::string& path) {
    std::map<std::string, std::vector<std::vector<std::uint8_t>>> messages;
    lcm_eventlog_t* const log = lcm_eventlog_create(path.c_str(), "r");
    EXPECT_NE(log, nullptr);
    if (log == nullptr) return messages;
    while (lcm_eventlog_event_t* const event = lcm_eventlog_read_next_event(log)) {
        const auto* const data = static_cast<const std::uint8_t*>(event->data);
        messages[event->channel].emplace_back(data, data + event->datalen);
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    return messages;
}

/// The message with its memory freed; every field that is looked at here is a number.
hitchview_hitch_angle_t DecodeAngle(const std::vector<std::uint8_t>& message) {
    hitchview_hitch_angle_t angle{};
    EXPECT_GT(
        hitchview_hitch_angle_t_decode(message.data(), 0, static_cast<int>(message.size()), &angle),
        0);
    hitchview_hitch_angle_t_decode_cleanup(&angle);
    return angle;
}

hitchview_panorama_status_t DecodeStatus(const std::vector<std::uint8_t>& message) {
    hitchview_panorama_status_t status{};
    EXPECT_GT(hitchview_panorama_status_t_decode(message.data(), 0,
                                                 static_cast<int>(message.size()), &status),
              0);
    hitchview_panorama_status_t_decode_cleanup(&status);
    return status;
}

class LcmRunTest : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        tests::RecordSmallDrive(*folder_, kFrames, kFrames);
    }
    static void TearDownTestSuite() { folder_.reset(); }

    void SetUp() override {
        if (std::string(LCM_LOGGER).ends_with("NOTFOUND"))
            GTEST_SKIP() << "lcm-logger is not installed";
    }

    /// `hitchview run` on the recorded drive with the usual canvas, logged to `log.lcm`.
    void Run(const std::string& more) {
        if (ran_with_ == more) return;  // the test before looked at the same run
        ran_with_ = more;
        const std::string rig = tests::SmallDriveRig(*folder_, "{projection: cylinder}", more);
        std::filesystem::remove(*folder_ / "log.lcm");
        Receiver receiver(kFrames);
        {
            const BackgroundProgram logger(
                LCM_LOGGER,
                {"--quiet", "--force",
                 std::string("--lcm-url=") + drivers::kDefaultLcmUrl + "&recv_buf_size=8388608",
                 *folder_ / "log.lcm"});
            WaitForLog();
            EXPECT_EQ(RunProgram(HITCHVIEW, {"run", "--rig", rig, "--out", *folder_ / "out"}), 0);
            std::this_thread::sleep_for(milliseconds(500));
        }
        counts_ = receiver.Finish();
        report_ = nlohmann::json::parse(tests::FileText(*folder_ / "out/report.json"));
        log_ = ReadLog(*folder_ / "log.lcm");
    }

    void ExpectEveryPanoramaArrived() {
        const int dropped = report_.at("dropped");
        EXPECT_EQ(counts_.received, kFrames - dropped);
        EXPECT_EQ(counts_.missing, dropped);
        EXPECT_EQ(counts_.undecodable, 0);
    }

    static std::unique_ptr<TemporaryFolder> folder_;
    static std::optional<std::string> ran_with_;
    static Receiver::Counts counts_;
    static nlohmann::json report_;
    static std::map<std::string, std::vector<std::vector<std::uint8_t>>> log_;

 private:
    /// lcm-logger makes its file before it subscribes, at once.
    static void WaitForLog() {
        for (int i = 0; i < 100 && !std::filesystem::exists(*folder_ / "log.lcm"); ++i) {
            std::this_thread::sleep_for(milliseconds(50));
        }
        std::this_thread::sleep_for(milliseconds(200));
    }
};

std::unique_ptr<TemporaryFolder> LcmRunTest::folder_;
std::optional<std::string> LcmRunTest::ran_with_;
Receiver::Counts LcmRunTest::counts_;
nlohmann::json LcmRunTest::report_;
std::map<std::string, std::vector<std::vector<std::uint8_t>>> LcmRunTest::log_;

TEST_F(LcmRunTest, EveryPanoramaAndTheHitchAngleArriveAtOtherPrograms) {
    Run(std::string("can:\n  source: {simulated: true}\n") + tests::kSimulatedHitchAngle);
    EXPECT_LE(report_.at("dropped").get<int>(), kMostDropped);
    ExpectEveryPanoramaArrived();

    const auto& statuses = log_["PANORAMA_STATUS"];
    ASSERT_FALSE(statuses.empty());
    for (const auto& message : statuses)
        EXPECT_EQ(DecodeStatus(message).spread_ns, 0) << "all cameras are recorded at one pace";
    const auto& angles = log_["HITCH_ANGLE"];
    EXPECT_GE(angles.size(), 100U);  // 150 in three seconds
    constexpr milliseconds kPeriod{20};
    constexpr double kQuantum_rad = 0.1 / 180 * 3.14159265;
    const drivers::Motion drive{drivers::SimulationOptions{}};
    const std::int64_t start_ns = DecodeStatus(statuses.front()).capture_ns -
                                  33'333'333LL * DecodeStatus(statuses.front()).sequence;
    for (const auto& message : angles) {
        const hitchview_hitch_angle_t angle = DecodeAngle(message);
        const hal::Instant at = kPeriod * angle.sequence;
        EXPECT_TRUE(angle.valid);
        EXPECT_NEAR(angle.angle_rad, drive.HitchAngleAt(at), 0.51 * kQuantum_rad) << angle.sequence;
        EXPECT_NEAR(static_cast<double>(angle.capture_ns - start_ns),
                    static_cast<double>(at.count()), 1e6);
    }
}

TEST_F(LcmRunTest, PreviewsOfAllCamerasAndOverlaysAreSentBesides) {
    Run("");
    int cameras = 0;
    for (const auto& [channel, messages] : log_) {
        if (!channel.starts_with("PREVIEW_")) continue;
        ++cameras;
        EXPECT_GE(messages.size(), 2U) << channel;
        EXPECT_LE(messages.size(), 8U) << channel;
    }
    EXPECT_EQ(cameras, 8);
    const auto& overlays = log_["PANORAMA_OVERLAY"];
    ASSERT_GE(overlays.size(), 3U);
    EXPECT_LE(overlays.size(), 17U);
    hitchview_overlay_t overlay{};
    ASSERT_GT(hitchview_overlay_t_decode(overlays.back().data(), 0,
                                         static_cast<int>(overlays.back().size()), &overlay),
              0);
    EXPECT_EQ(overlay.width, 2048);
    EXPECT_EQ(overlay.nvertices, 2 * overlay.mesh_rows * overlay.mesh_cols);
    EXPECT_GT(overlay.seam_rows, 10);
    hitchview_overlay_t_decode_cleanup(&overlay);
}

TEST_F(LcmRunTest, WithoutACanBusNoHitchAngleIsSent) {
    Run("");
    ExpectEveryPanoramaArrived();
    EXPECT_GT(log_["PANORAMA_STATUS"].size(), 0U);
    EXPECT_EQ(log_["HITCH_ANGLE"].size(), 0U);
}

TEST_F(LcmRunTest, HealthComesOnceASecondFromTheStart) {
    Run("");
    const auto& messages = log_["PANORAMA_HEALTH"];
    ASSERT_GE(messages.size(), 3U);  // at 0, 1 and 2 of three seconds
    EXPECT_LE(messages.size(), 5U);
    std::int32_t sequence = 0;
    for (const auto& bytes : messages) {
        hitchview_health_t health{};
        ASSERT_GT(
            hitchview_health_t_decode(bytes.data(), 0, static_cast<int>(bytes.size()), &health), 0);
        EXPECT_EQ(health.sequence, sequence++);
        EXPECT_STREQ(health.version, HITCHVIEW_VERSION);
        EXPECT_STRNE(health.calibration_id, "");
        EXPECT_STREQ(health.warning, "");
        EXPECT_EQ(health.image_budget_bytes, 150'000);
        EXPECT_GT(health.rss_bytes, 10'000'000);
        EXPECT_LE(health.heap_calls, 0);
        ASSERT_EQ(health.ncameras, 8);
        EXPECT_STREQ(health.cameras[0].unit, "tractor");
        EXPECT_STREQ(health.cameras[7].unit, "trailer");
        ASSERT_EQ(health.nstages, 10);
        EXPECT_STREQ(health.stages[9].name, "latency");
        if (health.sequence > 0) {
            EXPECT_GT(health.panoramas, 0);
            EXPECT_GT(health.panoramas_per_s, 0);
            EXPECT_GT(health.image_bytes, 1000);
            EXPECT_GT(health.cameras[3].frames_per_s, 0);
            EXPECT_GT(health.stages[5].p50_ms, 0);
        }
        hitchview_health_t_decode_cleanup(&health);
    }
}

TEST_F(LcmRunTest, EventsAreCountedInTheReportAndAllAreSent) {
    Run("");
    std::map<std::int16_t, int> codes;
    for (const auto& bytes : log_["PANORAMA_EVENT"]) {
        hitchview_event_t event{};
        ASSERT_GT(hitchview_event_t_decode(bytes.data(), 0, static_cast<int>(bytes.size()), &event),
                  0);
        ++codes[event.code];
        hitchview_event_t_decode_cleanup(&event);
    }
    const nlohmann::json& events = report_.at("events");
    EXPECT_EQ(codes[HITCHVIEW_EVENT_T_SEAM_LOCKED], events.at("seam_locked"));
    EXPECT_EQ(codes[HITCHVIEW_EVENT_T_SEAM_COAST], events.at("seam_coast"));
    EXPECT_EQ(codes[HITCHVIEW_EVENT_T_DEADLINE_MISSED], events.at("deadline_missed"));
    EXPECT_EQ(codes[HITCHVIEW_EVENT_T_PANORAMAS_DROPPED], events.at("panoramas_dropped"));
    EXPECT_EQ(events.at("refused"), 0);
}

}  // namespace
}  // namespace hitchview::app
