#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "tests/device/live_report.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/recorded_events.hpp"
#include "tests/support/simulated_rig_files.hpp"

// The program on looped cameras that run at their own pace. Runs in a network namespace of its own
// (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using nlohmann::json;
using tests::Count;

constexpr double kPeriod_ms = 33.333333;

json ReportIn(const std::filesystem::path& folder) {
    return json::parse(tests::FileText(folder / "report.json"));
}

class LoopedRunTest : public testing::Test {
 protected:
    LoopedRunTest() { tests::WriteSimulatedCalibration(folder_, 320, 180); }

    std::string Rig() const {
        return folder_.Write(
            "rig.yaml",
            "schema: 1\ncanvas: {projection: cylinder, size_px: [1024, 180]}\n"
            "calibration: rig.calib.yaml\n" +
                tests::SimulatedUnits([](const std::string&) { return "{simulated: true}"; }) +
                "simulation: {camera_size_px: [320, 180], loop_frames: 12, live: true}\n"
                "can:\n  source: {simulated: true}\n" +
                tests::kSimulatedHitchAngle);
    }

    /// The arguments, and with them the trap for heap calls where there is one.
    static int Run(std::vector<std::string> arguments) {
        if (tests::kHeapCallsAreCounted) arguments.emplace_back("--trap-alloc");
        return RunProgram(HITCHVIEW, arguments);
    }

    tests::TemporaryFolder folder_;
};

/// Of `live.cameras` in a report: by its own stamps it ran at the rate of the rig.
void ExpectPace(const json& cameras) {
    EXPECT_EQ(cameras.size(), 8U);
    for (const auto& [name, camera] : cameras.items()) {
        EXPECT_NEAR(camera.at("period_ms").get<double>(), kPeriod_ms, 1e-3) << name;
        EXPECT_EQ(Count(camera, "corrupted"), 0U) << name;
        EXPECT_EQ(Count(camera, "reopened"), 0U) << name;
    }
}

TEST_F(LoopedRunTest, EightCamerasRunAtTheirRateWithoutHeapCalls) {
    constexpr int kFrames = 90;
    const std::filesystem::path out = folder_ / "out";
    ASSERT_EQ(Run({"run", "--rig", Rig(), "--out", out, "--frames", std::to_string(kFrames)}), 0);
    const json report = ReportIn(out);
    std::printf("%s\n", report.at("live").dump().c_str());
    EXPECT_EQ(report.at("frames"), kFrames);
    tests::ExpectFramesAccountedFor(report);
    ExpectPace(report.at("live").at("cameras"));
    // A machine that is too busy leaves sets out; what it makes and what it leaves out takes the
    // time that the cameras take.
    const json& sets = report.at("live").at("sets");
    const double periods = static_cast<double>(Count(sets, "skipped")) + kFrames;
    const double took_ms = 1e3 * kFrames / report.at("frames_per_second").get<double>();
    EXPECT_GT(took_ms, (periods - 3) * kPeriod_ms);
    EXPECT_EQ(Count(sets, "empty"), 0U);
    // Every 20 ms one.
    EXPECT_GT(Count(report.at("can"), "angles"), (kFrames - 3) * kPeriod_ms / 20);
    if (!tests::kHeapCallsAreCounted) return;
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0) << report.at("heap_calls_by_thread");
}

TEST_F(LoopedRunTest, TheSimulatedBoardIsRecordedLiveAndItsRigRunsAgain) {
    const std::filesystem::path out = folder_ / "drive";
    ASSERT_EQ(Run({"record", "--board", "sim", "--live", "--loop-frames", "4", "--camera-width",
                   "320", "--seconds", "2", "--min-free-mb", "0", "--out", out}),
              0);
    const json report = ReportIn(out);
    ExpectPace(report.at("live").at("cameras"));
    std::map<std::string, std::uint64_t> channels;
    for (const auto& event : tests::RecordedEvents(out)) ++channels[event.channel];
    std::uint64_t recorded = 0;
    for (const auto& [name, camera] : report.at("recording").at("cameras").items())
        recorded += Count(camera, "recorded");
    std::uint64_t logged = 0;
    for (const auto& [channel, messages] : channels)
        if (channel.starts_with("CAM_")) logged += messages;
    EXPECT_EQ(logged, recorded);
    EXPECT_GT(recorded, 0U);
    EXPECT_GT(channels["HITCH_ANGLE"], 0U);
    EXPECT_EQ(Run({"run", "--rig", out / "rig.yaml", "--frames", "10"}), 0);
}

TEST_F(LoopedRunTest, LiveCamerasAreNotReplayed) {
    EXPECT_NE(RunProgram(HITCHVIEW_DESK, {"replay", "--rig", Rig()}), 0);
}

}  // namespace
}  // namespace hitchview::app
