#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/check_verb.hpp"
#include "app/log_check.hpp"
#include "app/log_recording.hpp"
#include "app/log_repair.hpp"
#include "app/log_report.hpp"
#include "tests/support/log_messages.hpp"
#include "tests/support/random_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using testing::Contains;
using testing::HasSubstr;
using tests::MessageLog;

const std::atomic<bool> kGoOn{false};
constexpr std::int64_t kPeriod_ns = 33'000'000;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr int kFrames = 3000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LogFigures Measured(const std::vector<std::filesystem::path>& logs) {
    LogRecording recording(LogFiles(logs).value(), kGoOn);
    LogCheck check;
    while (const auto event = recording.Next()) check.Add(event.value());
    LogFigures figures = check.Figures();
    figures.damage = recording.damage();
    return figures;
}

const CameraFigures& Camera(const LogFigures& figures, const std::string& channel) {
    return *std::ranges::find(figures.cameras, channel, &CameraFigures::channel);
}

class LogCheckTest : public testing::Test {
 protected:
    LogFigures Measured() { return app::Measured({file_}); }

    tests::TemporaryFolder folder_;
    std::string file_ = folder_ / "log.lcm";
};

/// Three cameras: B two milliseconds later, C three; C's clock gains 100 ppm; B loses three frames
/// in two places.
void WriteThreeCameras(MessageLog& log) {
    log.Rig({"a", "b", "c"}, {"CAM_A", "CAM_B", "CAM_C"}, 33.0);
    for (int i = 0; i < kFrames; ++i) {
        const auto sequence = static_cast<std::uint32_t>(i);
        const std::int64_t at_ns = kSecond_ns + i * kPeriod_ns;
        log.Picture("CAM_A", {.captured_ns = at_ns, .sequence = sequence});
        if (i != 100 && i != 101 && i != 200)
            log.Picture("CAM_B", {.captured_ns = at_ns + 2'000'000, .sequence = sequence});
        const std::int64_t gained_ns = i * kPeriod_ns / 10'000;
        log.Picture("CAM_C", {.captured_ns = at_ns + 3'000'000 + gained_ns, .sequence = sequence});
    }
}

TEST_F(LogCheckTest, FindsLostFramesGapsAndDriftOfEachCamera) {
    {
        MessageLog log(file_);
        WriteThreeCameras(log);
    }
    const LogFigures figures = Measured();
    const CameraFigures& b = Camera(figures, "CAM_B");
    EXPECT_EQ(b.frames.messages, kFrames - 3U);
    EXPECT_EQ(b.frames.lost, 3U);
    EXPECT_EQ(b.frames.gaps, 2U);
    EXPECT_EQ(b.time_gaps, 2U);
    EXPECT_NEAR(*b.longest_gap_ms, 99.0, 1e-6);
    EXPECT_NEAR(*b.period_ms, 33.0, 1e-9);
    EXPECT_NEAR(*b.drift_ppm, 0, 1e-6);
    EXPECT_EQ(Camera(figures, "CAM_A").frames.lost, 0U);
    EXPECT_NEAR(*Camera(figures, "CAM_C").drift_ppm, 100, 0.01);
}

TEST_F(LogCheckTest, FindsTheSpreadOfFrameSets) {
    {
        MessageLog log(file_);
        WriteThreeCameras(log);
    }
    // From A to C: 3 ms, and 3.3 us more with every set.
    const SetFigures sets = Measured().sets;
    EXPECT_EQ(sets.sets, static_cast<std::uint64_t>(kFrames));
    EXPECT_EQ(sets.complete, kFrames - 3U);
    EXPECT_NEAR(*sets.p50_ms, 3 + 0.0033 * 1500, 0.01);
    EXPECT_NEAR(*sets.p99_ms, 3 + 0.0033 * 2970, 0.01);
    EXPECT_NEAR(*sets.max_ms, 3 + 0.0033 * 2999, 0.01);
}

TEST_F(LogCheckTest, ACameraThatGaveNothingIsNamedByTheRig) {
    {
        MessageLog log(file_);
        log.Rig({"a", "gone"}, {"CAM_A", "CAM_GONE"}, 33.0);
        log.Picture("CAM_A", {});
    }
    const LogFigures figures = Measured();
    EXPECT_EQ(Camera(figures, "CAM_GONE").frames.messages, 0U);
    EXPECT_THAT(Judge(figures).reasons, Contains("CAM_GONE has no frame"));
}

TEST_F(LogCheckTest, FindsSilencesOfTheCanBusAndItsErrors) {
    {
        MessageLog log(file_);
        for (const std::int64_t at_ms : {0, 10, 20, 2520, 2530}) {
            hal::CanFrame frame{.id = 5, .size_bytes = 2};
            frame.received_at = std::chrono::milliseconds(at_ms);
            log.Can(frame);
        }
        hal::CanFrame error{.id = 4, .kind = hal::CanFrameKind::kError, .size_bytes = 8};
        error.received_at = std::chrono::milliseconds(2540);
        log.Can(error);
    }
    const CanFigures can = Measured().can;
    EXPECT_EQ(can.frames, 6U);
    EXPECT_EQ(can.errors, 1U);
    EXPECT_EQ(can.gaps, 1U);
    EXPECT_NEAR(*can.longest_gap_ms, 2500, 1e-9);
}

TEST_F(LogCheckTest, ComparesArticulationWithTheHitchAngleOfTheSameMoment) {
    {
        // The vehicle's angle grows by 0.1 rad a second and is read every 100 ms; the images say
        // 0.02 rad more, in between.
        MessageLog log(file_);
        for (std::uint32_t i = 0; i < 100; ++i) {
            const std::int64_t at_ns = i * kSecond_ns / 10;
            log.HitchAngle(at_ns, i, hal::HitchAngleQuality::kValid, 0.01 * i);
            log.Status(at_ns + 30'000'000, i, 0.01 * i + 0.003 + (i == 50 ? -0.05 : 0.02));
        }
        log.HitchAngle(10 * kSecond_ns, 100, hal::HitchAngleQuality::kStale, kNaN);
        log.Status(10 * kSecond_ns, 100, kNaN);
    }
    const LogFigures figures = Measured();
    EXPECT_EQ(figures.articulation.compared, 99U);
    EXPECT_NEAR(*figures.articulation.median_rad, 0.02, 1e-9);
    EXPECT_NEAR(*figures.articulation.max_abs_rad, 0.05, 1e-9);
    EXPECT_NEAR(*figures.hitch_angle.least_rad, 0, 1e-9);
    EXPECT_NEAR(*figures.hitch_angle.most_rad, 0.99, 1e-9);
    EXPECT_EQ(figures.hitch_angle.qualities[4], 1U);
}

TEST_F(LogCheckTest, FindsStepsOfTheWallClock) {
    {
        MessageLog log(file_);
        for (int i = 0; i < 10; ++i) {
            if (i == 4) log.epoch_ns -= 5 * kSecond_ns;
            if (i == 7) log.epoch_ns += 4'000'000;  // slewed
            log.Clock(i * kSecond_ns);
        }
    }
    const ClockFigures clock = Measured().clock;
    EXPECT_EQ(clock.steps, 1U);
    EXPECT_NEAR(*clock.largest_step_ms, 5000, 1e-9);
    EXPECT_EQ(clock.log_steps_back, 1U);
}

TEST_F(LogCheckTest, ListsEventsAndCountsMissingPanoramas) {
    {
        MessageLog log(file_);
        log.Event(5 * kSecond_ns, 0, 1, "front", "no frame for 500 ms");
        for (std::uint32_t sequence : {0U, 1U, 5U}) log.Status(0, sequence, kNaN);
    }
    const LogFigures figures = Measured();
    EXPECT_EQ(figures.panoramas.status.lost, 3U);
    ASSERT_EQ(figures.listed_events.size(), 1U);
    EXPECT_THAT(LogTable(figures, Judge(figures)),
                HasSubstr("deadlines missed\nevent         2023-11-14T22:13:25.000000Z 1 front: no "
                          "frame for 500 ms"));
}

TEST_F(LogCheckTest, AMessageThatIsNotWhatItsChannelHoldsIsCounted) {
    {
        MessageLog log(file_);
        log.Clock(0);
        log.Bytes("CLOCK", 1, {1, 2, 3});
        log.Bytes("SOMEONE_ELSES", 2, {1, 2, 3});
    }
    EXPECT_EQ(Measured().undecodable, 1U);
}

TEST_F(LogCheckTest, SegmentsOfAFolderAreOneRecording) {
    for (const int segment : {0, 1}) {
        MessageLog log(folder_ / ("20260101T000000Z-000" + std::to_string(segment) + ".lcm"));
        const auto sequence = static_cast<std::uint32_t>(segment);
        log.Picture("CAM_A", {.captured_ns = segment * kPeriod_ns, .sequence = sequence});
    }
    const CameraFigures a = Camera(app::Measured({folder_.path()}), "CAM_A");
    EXPECT_EQ(a.frames.messages, 2U);
    EXPECT_EQ(a.frames.lost, 0U);
    EXPECT_EQ(a.frames.resets, 0U);
}

TEST_F(LogCheckTest, GoodRecordingsAreGoodAndBadOnesSayWhy) {
    {
        MessageLog log(file_);
        WriteThreeCameras(log);
    }
    LogFigures figures = Measured();
    EXPECT_TRUE(Judge(figures).good());
    figures.cameras[0].frames.lost = 30;
    figures.cameras[1].drift_ppm = -300;
    figures.sets.p99_ms = 20;
    EXPECT_THAT(Judge(figures).reasons,
                testing::ElementsAre("CAM_A lost 30 frames of 3030 in 0 places (0.99 %)",
                                     "CAM_B drifts by -300 ppm",
                                     HasSubstr("the cameras are not synchronised")));
}

TEST_F(LogCheckTest, ARepairedLogHoldsEveryWholeEventAndLiblcmReadsIt) {
    tests::RandomLog log(1, 50);
    for (const int event : {10, 20})
        log.bytes[log.events[static_cast<std::size_t>(event)].position_bytes] = 0;
    log.bytes.resize(log.bytes.size() - 1);
    tests::WriteBytes(file_, log.bytes);
    const std::string repaired = folder_ / "repaired.lcm";
    LogRecording recording({file_}, kGoOn);
    const auto repair = RepairLog(recording, repaired);
    ASSERT_TRUE(repair.ok());
    EXPECT_EQ(repair.value().events, 47U);
    EXPECT_EQ(recording.damage().lost_events, 3U);
    EXPECT_FALSE(RepairLog(recording, repaired).ok()) << "an existing log was replaced";

    lcm_eventlog_t* const stock = lcm_eventlog_create(repaired.c_str(), "r");
    std::int64_t number = 0;
    for (std::size_t i = 0; i < log.events.size() - 1; ++i) {
        if (i == 10 || i == 20) continue;
        lcm_eventlog_event_t* const read = lcm_eventlog_read_next_event(stock);
        ASSERT_NE(read, nullptr);
        EXPECT_EQ(read->eventnum, number++);
        EXPECT_EQ(read->timestamp, log.events[i].utime_us);
        lcm_eventlog_free_event(read);
    }
    EXPECT_EQ(lcm_eventlog_read_next_event(stock), nullptr);
    lcm_eventlog_destroy(stock);
}

TEST_F(LogCheckTest, AStopLeavesNoHalfRepairedLog) {
    tests::WriteBytes(file_, tests::RandomLog(1, 50).bytes);
    const std::atomic<bool> stop{true};
    LogRecording recording({file_}, stop);
    const auto repair = RepairLog(recording, folder_ / "repaired.lcm");
    ASSERT_FALSE(repair.ok());
    EXPECT_EQ(repair.error(), "stopped");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "repaired.lcm"));
}

TEST_F(LogCheckTest, TheVerbTellsByItsExitCode) {
    {
        MessageLog log(file_);
        WriteThreeCameras(log);
    }
    EXPECT_EQ(CheckVerb({.logs = {file_}}, kGoOn), 0);
    std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
    EXPECT_EQ(CheckVerb({.logs = {file_}}, kGoOn), 1);
    EXPECT_EQ(CheckVerb({.logs = {folder_ / "absent"}}, kGoOn), 2);
    EXPECT_EQ(CheckVerb({.logs = {folder_.Write("text.lcm", "not a log")}}, kGoOn), 2);
}

TEST_F(LogCheckTest, AsJsonTheAnswerIsOneDocumentAlone) {
    {
        MessageLog log(file_);
        WriteThreeCameras(log);
    }
    testing::internal::CaptureStdout();
    const int code =
        CheckVerb({.logs = {file_}, .json = true, .repair = folder_ / "repaired.lcm"}, kGoOn);
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_EQ(code, 0);
    const auto report = nlohmann::json::parse(text, nullptr, false);
    ASSERT_TRUE(report.is_object()) << text;
    EXPECT_EQ(report["verdict"], "good");
    EXPECT_EQ(report["cameras"]["CAM_B"]["lost"], 3);
    EXPECT_TRUE(report["hitch_angle"]["least_rad"].is_null());
}

}  // namespace
}  // namespace hitchview::app
