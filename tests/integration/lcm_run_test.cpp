#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.hpp"
#include "drivers/lcm_url.hpp"
#include "drivers/simulated_motion.hpp"
#include "lcmtypes/hitchview_hitch_angle_t.h"
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
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
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
    Receiver::Counts counts_;
    nlohmann::json report_;
    std::map<std::string, std::vector<std::vector<std::uint8_t>>> log_;

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

TEST_F(LcmRunTest, WithoutACanBusNoHitchAngleIsSent) {
    Run("");
    ExpectEveryPanoramaArrived();
    EXPECT_GT(log_["PANORAMA_STATUS"].size(), 0U);
    EXPECT_EQ(log_["HITCH_ANGLE"].size(), 0U);
    EXPECT_EQ(log_["PANORAMA_EVENT"].size(), 0U);
}

}  // namespace
}  // namespace hitchview::app
