#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/replay_verb.hpp"
#include "tests/support/plane_rig_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct Refusal {
    int code = 0;
    std::string text;
};

/// What the verb answers to a rig file.
Refusal Replay(const std::string& rig, const std::string& out) {
    const std::atomic<bool> stop{false};
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    ReplayOptions options{.rig = rig, .run = {.out = out, .frames = 3}};
    const int code = ReplayVerb(options, stop);
    testing::internal::GetCapturedStdout();
    return {code, testing::internal::GetCapturedStderr()};
}

class RefusalTest : public testing::Test {
 protected:
    void ExpectRefused(const std::string& rig, int code, const std::string& why) {
        const std::string out = folder_ / "out";
        const Refusal refusal = Replay(rig, out);
        EXPECT_EQ(refusal.code, code);
        EXPECT_THAT(refusal.text, HasSubstr(why));
        EXPECT_THAT(refusal.text, HasSubstr(folder_.path()));
        EXPECT_FALSE(std::filesystem::exists(out));
    }
    std::string Ring(const std::string& units, const std::string& simulation) {
        return folder_.Write("rig.yaml",
                             "schema: 1\n"
                             "canvas: {projection: cylinder, size_px: [1024, 180]}\n"
                             "calibration: rig.calib.yaml\n" +
                                 units + "simulation: " + simulation + "\n");
    }

    tests::TemporaryFolder folder_;
};

TEST_F(RefusalTest, AMissingRecordingIsNamed) {
    const std::string rig =
        folder_.Write("rig.yaml",
                      "schema: 1\n"
                      "canvas: {projection: plane, size_px: [640, 300]}\n"
                      "units:\n"
                      "  tractor: {cameras: [{name: a, source: {replay: no.avi}}]}\n");
    ExpectRefused(rig, 3, "no.avi: no such file");
}

TEST_F(RefusalTest, ACameraOfAnotherSizeThanCalibratedIsNamedWithBothSizes) {
    tests::WriteSimulatedCalibration(folder_, 640, 360);
    const auto units =
        tests::SimulatedUnits([](const std::string&) { return "{simulated: true}"; });
    ExpectRefused(Ring(units, "{frames: 3, camera_size_px: [320, 180]}"), 3,
                  "camera front delivers 320x180 px, must be 640x360 as calibrated");
}

TEST_F(RefusalTest, ASimulatedCameraOfTheOtherUnitIsNamed) {
    tests::WriteSimulatedCalibration(folder_, 320, 180);
    const std::string units =
        "units: {tractor: {cameras: [{name: rear, source: {simulated: true}}]}}\n";
    ExpectRefused(Ring(units, "{frames: 3}"), 3, "cameras.rear.unit is trailer, must be tractor");
}

TEST_F(RefusalTest, AScenarioThatThereIsNotIsNamedWithThoseThatThereAre) {
    tests::WriteSimulatedCalibration(folder_, 320, 180);
    const auto units =
        tests::SimulatedUnits([](const std::string&) { return "{simulated: true}"; });
    ExpectRefused(Ring(units, "{scenario: fog}"), 3,
                  "simulation.scenario is fog, must be one of straight, vibration, turn_left_60");
}

TEST_F(RefusalTest, ASimulatedCameraThatTheRigDoesNotHaveIsNamed) {
    const std::string rig =
        folder_.Write("rig.yaml",
                      "schema: 1\n"
                      "canvas: {projection: plane, size_px: [640, 300]}\n"
                      "units:\n"
                      "  tractor: {cameras: [{name: mast, source: {simulated: true}}]}\n");
    ExpectRefused(rig, 3, "camera mast of the tractor is not one that the simulated rig has");
}

TEST_F(RefusalTest, ARigFileWithMistakesIsWrongUse) {
    ExpectRefused(folder_.Write("rig.yaml", "schema: 2\n"), 2, "schema is 2, must be");
}

TEST_F(RefusalTest, VideosNeedAFolder) {
    const tests::PlaneRigFiles rig(0);
    const std::atomic<bool> stop{false};
    testing::internal::CaptureStderr();
    EXPECT_EQ(ReplayVerb({.rig = rig.Rig(), .run = {.write_video = true}}, stop), 2);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("--out is needed"));
}

json RunAndReadReport(const tests::PlaneRigFiles& rig, bool metrics) {
    const std::string out = rig.folder() / "out";
    const std::atomic<bool> stop{false};
    testing::internal::CaptureStdout();
    EXPECT_EQ(ReplayVerb({.rig = rig.Rig(), .run = {.out = out}, .metrics = metrics}, stop), 0);
    testing::internal::GetCapturedStdout();
    return json::parse(tests::FileText(out + "/report.json"));
}

TEST(ReportTest, HasEveryFigureAndNullForWhatWasNotMeasured) {
    const json report = RunAndReadReport(tests::PlaneRigFiles(2), false);
    EXPECT_EQ(report.at("frames"), tests::PlaneRigFiles::kFrames);
    EXPECT_GT(report.at("period_ms"), 33.0);
    EXPECT_GE(report.at("deadline_misses"), 0);
    EXPECT_TRUE(report.contains("heap_calls_after_ready"));
    EXPECT_GT(report.at("rss_bytes"), 1'000'000);
    for (const char* stage : {"motion", "map", "gains", "bands", "render", "total"}) {
        for (const char* figure : {"p50_ms", "p99_ms", "max_ms"}) {
            EXPECT_GE(report.at("stages").at(stage).at(figure), 0) << stage << ' ' << figure;
        }
    }
    EXPECT_GT(report["stages"]["total"]["max_ms"], 0);
    for (const char* unit : {"tractor", "trailer"}) {
        for (const char* figure :
             {"cropping_mean", "cropping_min", "distortion_min", "stability", "jitter_ratio"}) {
            EXPECT_TRUE(report.at("units").at(unit).at(figure).is_null()) << unit << ' ' << figure;
        }
    }
    EXPECT_TRUE(report.at("articulation").is_null()) << "a plane has no calibrated hinge";
    const json& seam = report.at("seams").at("right");
    for (const char* figure : {"median_px", "p95_px", "worst_frame_px"}) {
        EXPECT_TRUE(seam.at(figure).is_null()) << figure;
    }
    EXPECT_EQ(seam.at("locked_share"), 1);
}

TEST(ReportTest, HasTheMeasuredFiguresWithMetrics) {
    const json report = RunAndReadReport(tests::PlaneRigFiles(2), true);
    EXPECT_EQ(report.at("frames"), tests::PlaneRigFiles::kFrames);
    EXPECT_TRUE(report["units"]["tractor"]["distortion_min"].is_number());
    EXPECT_TRUE(report["units"]["trailer"]["jitter_ratio"].is_number());
    EXPECT_LT(report["seams"]["right"]["median_px"], 1.0);
    EXPECT_EQ(report["seams"]["right"]["locked_share"], 1);
}

}  // namespace
}  // namespace hitchview::app
