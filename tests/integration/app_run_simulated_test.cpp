#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/report.hpp"
#include "tests/support/shown_panoramas.hpp"
#include "tests/support/simulated_rig_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using testing::HasSubstr;
using testing::Not;
using tests::FileText;
using tests::KeptPanorama;
using tests::RunAndKeep;

constexpr int kFrames = 12;

/// A drive of the simulated tractor-trailer, small.
class SimulatedRunTest : public testing::Test {
 protected:
    SimulatedRunTest() { tests::WriteSimulatedCalibration(folder_, 320, 180); }

    /// `more`: further keys of the rig file.
    std::string Rig(const std::string& more = "") {
        const std::string units =
            tests::SimulatedUnits([](const std::string&) { return "{simulated: true}"; });
        return folder_.Write("rig.yaml",
                             "schema: 1\n"
                             "canvas: {projection: cylinder, size_px: [1024, 180]}\n"
                             "calibration: rig.calib.yaml\n" +
                                 units + "simulation: {frames: " + std::to_string(kFrames) +
                                 ", camera_size_px: [320, 180]}\n" + more);
    }

    /// Goes with a `can:` section; what is published ends up in the file.
    std::string PublishTo(const std::string& log) const {
        return "publish: {url: \"file://" + (folder_ / log) + "?mode=w\"}\n";
    }

    tests::TemporaryFolder folder_;
};

void ExpectSame(const std::vector<KeptPanorama>& a, const std::vector<KeptPanorama>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].sequence, b[i].sequence);
        EXPECT_TRUE(a[i].bytes == b[i].bytes) << "panorama " << i << " differs";
    }
}

/// The hitch angle as it stands in a candump log of 20 ms steps: every value it can have, jumping.
std::string WildAngles() {
    std::string log;
    for (int i = 0; i < 60; ++i) {
        std::array<char, 80> line{};
        const int raw = (i * 1531) % 4096;
        std::snprintf(line.data(), line.size(), "(1700000000.%06d) can0 457#0000%02X%X000000000\n",
                      20'000 * (i % 50), static_cast<unsigned>(raw >> 4),
                      static_cast<unsigned>(raw & 15));
        log += line.data();
    }
    return log;
}

TEST_F(SimulatedRunTest, TheHitchAngleNeverReachesThePanorama) {
    const auto without = RunAndKeep(Rig());
    ASSERT_EQ(without.size(), kFrames);
    const std::string hitch_angle = tests::kSimulatedHitchAngle;

    const std::string simulated = "can:\n  source: {simulated: true}\n" + hitch_angle;
    ExpectSame(without, RunAndKeep(Rig(simulated)));

    const auto published = RunAndKeep(Rig(simulated + PublishTo("true.lcm")), {.publish = true});
    EXPECT_THAT(FileText(folder_ / "true.lcm"), HasSubstr("HITCH_ANGLE"));
    ExpectSame(without, published);

    folder_.Write("can0.log", WildAngles());
    const std::string wild = "can:\n  source: {candump: can0.log}\n" + hitch_angle;
    const auto misled = RunAndKeep(Rig(wild + PublishTo("wild.lcm")), {.publish = true});
    EXPECT_THAT(FileText(folder_ / "wild.lcm"), HasSubstr("HITCH_ANGLE"));
    ExpectSame(without, misled);
}

TEST_F(SimulatedRunTest, WithoutACanBusNoHitchAngleIsPublished) {
    RunAndKeep(Rig(PublishTo("none.lcm")), {.frames = 3, .publish = true});
    const std::string log = FileText(folder_ / "none.lcm");
    EXPECT_THAT(log, HasSubstr("PANORAMA_STATUS"));
    EXPECT_THAT(log, Not(HasSubstr("HITCH_ANGLE")));
}

TEST_F(SimulatedRunTest, ThePanoramaIsTheSameOnAnyNumberOfWorkers) {
    const auto alone = RunAndKeep(Rig(), {.workers = 1});
    ASSERT_EQ(alone.size(), kFrames);
    for (const int workers : {2, 5}) ExpectSame(alone, RunAndKeep(Rig(), {.workers = workers}));
}

TEST_F(SimulatedRunTest, ALoopShowsTheDriveUntilItTurnsAndGoesOnToItsEnd) {
    constexpr int kLoop = 11;
    constexpr int kLength = 23;
    const auto rig = [&](const std::string& length) {
        std::string text = tests::FileText(Rig());
        const std::string key = "frames: " + std::to_string(kFrames);
        return folder_.Write("rig.yaml", text.replace(text.find(key), key.size(), length));
    };
    const auto drive = RunAndKeep(rig("frames: 300"), {.frames = kLoop});
    const auto looped = RunAndKeep(
        rig("loop_frames: " + std::to_string(kLoop) + ", frames: " + std::to_string(kLength)));
    ASSERT_EQ(looped.size(), kLength);
    ExpectSame(drive, {looped.begin(), looped.begin() + kLoop});
}

TEST_F(SimulatedRunTest, TheArticulationIsReported) {
    const std::atomic<bool> stop{false};
    const auto summary = RunRig(LoadRigConfig(Rig()).value(), {}, stop);
    ASSERT_TRUE(summary) << summary.error();
    const nlohmann::json articulation = MakeReport(summary.value(), nullptr).at("articulation");
    EXPECT_EQ(articulation.at("known_share"), 1);
    EXPECT_LE(articulation.at("least_rad"), articulation.at("most_rad"));
    EXPECT_GT(articulation.at("least_rad"), -0.2);  // the drive begins straight
    EXPECT_LT(articulation.at("most_rad"), 0.1);
    EXPECT_GT(articulation.at("sigma_rad"), 0);
}

TEST_F(SimulatedRunTest, PanoramasOfNeighbouringSetsDiffer) {
    const auto kept = RunAndKeep(Rig(), {.frames = 3});
    ASSERT_EQ(kept.size(), 3U);
    EXPECT_FALSE(kept[0].bytes == kept[1].bytes);
    EXPECT_FALSE(kept[1].bytes == kept[2].bytes);
}

TEST_F(SimulatedRunTest, ARingIsMadeOfflineToo) {
    for (const auto coupling : {algo::Coupling::kCorrected, algo::Coupling::kLiteral}) {
        const auto kept = RunAndKeep(Rig(), {.offline = true, .coupling = coupling});
        ASSERT_EQ(kept.size(), kFrames);
        for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i].sequence, i);
        const KeptPanorama& last = kept.back();
        EXPECT_LT(std::count(last.bytes.begin(), last.bytes.begin() + 1024 * 180, 0),
                  1024 * 180 / 2);
        for (const algo::Unit unit : algo::kUnits) {
            EXPECT_TRUE(last.composition.M_canvas_view[unit].isUnitary(1e-6)) << "no rotation";
        }
        EXPECT_EQ(last.composition.discrepancy.col(algo::Mesh::Index(4, 0)),
                  last.composition.discrepancy.col(algo::Mesh::Index(4, algo::Mesh::kCols)));
    }
}

class LookaheadTest : public SimulatedRunTest, public testing::WithParamInterface<int> {};

TEST_P(LookaheadTest, EachFrameSetIsShownOnceAndInOrder) {
    const auto kept = RunAndKeep(Rig(), {.lookahead_frames = GetParam()});
    ASSERT_EQ(kept.size(), kFrames);
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i].sequence, i);
    // The last one is a picture, too: most of it is not black.
    const auto& luma = kept.back().bytes;
    EXPECT_LT(std::count(luma.begin(), luma.begin() + 1024 * 180, 0), 1024 * 180 / 2);
}

TEST_P(LookaheadTest, ARunEndsAfterTheFramesAskedFor) {
    const auto kept = RunAndKeep(Rig(), {.frames = 5, .lookahead_frames = GetParam()});
    ASSERT_EQ(kept.size(), 5U);
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i].sequence, i);
}

TEST_P(LookaheadTest, ARunEndsAfterTheTimeAskedFor) {
    RunOptions options;
    options.lookahead_frames = GetParam();
    for (const int duration_ms : {200, 233}) {
        options.duration = std::chrono::milliseconds(duration_ms);
        EXPECT_EQ(RunAndKeep(Rig(), options).size(), duration_ms == 200 ? 6U : 7U) << duration_ms;
    }
}

INSTANTIATE_TEST_SUITE_P(Frames, LookaheadTest, testing::Values(0, 3, 10));

TEST_F(SimulatedRunTest, WithEverythingOffBothUnitsStayWhereTheyAre) {
    const auto kept =
        RunAndKeep(Rig("stabilization: {enabled: false}\nstitching: {enabled: false}\n"));
    ASSERT_EQ(kept.size(), kFrames);
    for (const KeptPanorama& panorama : kept) {
        const algo::Composition& c = panorama.composition;
        EXPECT_TRUE(c.discrepancy.isZero(0));
        for (const algo::Unit unit : algo::kUnits) {
            EXPECT_EQ(c.M_canvas_view[unit], Eigen::Matrix3d::Identity());
            EXPECT_TRUE(c.view_offset[unit].isZero(0));
        }
    }
}

TEST_F(SimulatedRunTest, WithStabilisationTheTractorIsMoved) {
    const auto kept = RunAndKeep(Rig());
    ASSERT_EQ(kept.size(), kFrames);
    EXPECT_NE(kept.back().composition.M_canvas_view[algo::Unit::kTractor],
              Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace hitchview::app
