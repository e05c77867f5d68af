#include <gtest/gtest.h>

#include "app/evaluation.hpp"
#include "app/run_loop.hpp"
#include "tests/support/simulated_rig_files.hpp"
#include "tests/support/test_data.hpp"

// Recordings that are too large to be part of the project: see tests/support/test_data.hpp.
namespace hitchview::app {
namespace {

using nlohmann::json;

struct Recording {
    std::string tractor;
    std::string trailer;
    std::string canvas;  ///< width, height
};

class RecordingsTest : public testing::Test {
 protected:
    /// Runs a rig of the two recordings. Skips the test when they are not there.
    void Run(const Recording& recording, bool write_views) {
        tractor_ = tests::TestData(recording.tractor);
        trailer_ = tests::TestData(recording.trailer);
        if (tractor_.empty() || trailer_.empty()) {
            GTEST_SKIP() << recording.tractor << " is not there: set HITCHVIEW_TEST_DATA";
        }
        const std::string file = folder_.Write(
            "rig.yaml",
            "schema: 1\ncanvas: {projection: plane, size_px: [" + recording.canvas +
                "]}\nunits:\n" + "  tractor: {cameras: [{name: a, source: {replay: " + tractor_ +
                "}}]}\n" + "  trailer: {cameras: [{name: b, source: {replay: " + trailer_ +
                "}}]}\n");
        const auto config = LoadRigConfig(file);
        ASSERT_TRUE(config) << config.error();
        const std::atomic<bool> stop{false};
        auto summary = RunRig(config.value(), {.out = folder_.path(), .write_views = write_views},
                              stop, [&](const ShownPanorama& shown, const Pipeline&) {
                                  EXPECT_EQ(shown.picture.header.sequence, shown_++);
                              });
        ASSERT_TRUE(summary) << summary.error();
        summary_ = std::move(summary.value());
    }

    /// Figures of the written views; every eighth frame is matched, which is enough for medians.
    json Measure() const {
        const auto quality =
            Evaluate({.units = {{{{.in = tractor_, .out = folder_ / "tractor.avi"},
                                  {.in = trailer_, .out = folder_ / "trailer.avi"}}}},
                      .step = 8});
        EXPECT_TRUE(quality) << quality.error();
        return quality ? quality.value().figures : json();
    }

    [[nodiscard]] double LockedShare() const {
        return static_cast<double>(summary_.locked_frames[algo::Overlap::kRight]) /
               static_cast<double>(summary_.frames);
    }

    tests::TemporaryFolder folder_;
    std::string tractor_;
    std::string trailer_;
    std::uint32_t shown_ = 0;
    RunSummary summary_;
};

/// Both views shake at most `share` of what their cameras do (rms jerk of the frame's centre).
void ExpectSteadier(const json& figures, double share) {
    for (const char* unit : {"tractor", "trailer"}) {
        const json& view = figures["units"][unit];
        EXPECT_LE(view["jerk_out_px"].get<double>(), share * view["jerk_in_px"].get<double>())
            << unit;
        EXPECT_EQ(view["frames_lost"], 0) << unit;
    }
}

class HandheldTest : public RecordingsTest, public testing::WithParamInterface<std::string> {};

TEST_P(HandheldTest, KeepsASeventhOfItsShakeAndItsSeamFits) {
    const std::string folder = "pairs/" + GetParam() + "/";
    Run({folder + "tractor.avi", folder + "trailer.avi", "1100, 520"}, true);
    if (IsSkipped() || HasFailure()) return;
    EXPECT_EQ(summary_.frames, 240U);
    const json figures = Measure();
    EXPECT_EQ(figures["frames"], 240);
    ExpectSteadier(figures, 0.15);
    EXPECT_LE(figures["seams"]["right"]["median_px"].get<double>(), 0.5);
    EXPECT_LE(figures["seams"]["right"]["worst_frame_px"].get<double>(), 1.5);
}

INSTANTIATE_TEST_SUITE_P(Pairs, HandheldTest, testing::Values("handheld-1", "handheld-10"));

TEST_F(RecordingsTest, ADriveWithParallaxKeepsAThirdOfItsShakeAndItsSeamFits) {
    Run({"pairs/stereo-drive-1/tractor.avi", "pairs/stereo-drive-1/trailer.avi", "1280, 480"},
        true);
    if (IsSkipped() || HasFailure()) return;
    EXPECT_EQ(summary_.frames, 51U);
    const json figures = Measure();
    ExpectSteadier(figures, 0.30);
    EXPECT_LE(figures["seams"]["right"]["median_px"].get<double>(), 1.5);
}

TEST_F(RecordingsTest, TheSeamOfTwoPhonesIsFoundAndKept) {
    Run({"pairs/rooftop/left.mp4", "pairs/rooftop/right.mp4", "800, 720"}, true);
    if (IsSkipped() || HasFailure()) return;
    EXPECT_EQ(summary_.frames, 296U);
    EXPECT_GT(LockedShare(), 0.9);
    const json figures = Measure();
    EXPECT_LE(figures["seams"]["right"]["median_px"].get<double>(), 1.5);
    EXPECT_LE(figures["seams"]["right"]["worst_frame_px"].get<double>(), 3.0);
}

struct Clip {
    std::string name;
    std::string stabilization;
    double jerk_px;
    double stability;  ///< at least
};

/// One camera alone: hand-held clips of 640 x 360, against what other programs reach on them.
class ClipTest : public testing::TestWithParam<Clip> {};

TEST_P(ClipTest, IsAsSteadyAsItsSettingAllows) {
    const std::string clip = tests::TestData("clips/" + GetParam().name + ".m4v");
    if (clip.empty()) {
        GTEST_SKIP() << GetParam().name << " is not there: set HITCHVIEW_TEST_DATA";
    }
    const tests::TemporaryFolder folder;
    const std::string file = folder.Write(
        "rig.yaml",
        "schema: 1\ncanvas: {projection: plane, size_px: [640, 360]}\nunits:\n  tractor: "
        "{cameras: [{name: a, source: {replay: " +
            clip + "}}]}\nstabilization: {" + GetParam().stabilization + "}\n");
    const auto config = LoadRigConfig(file);
    ASSERT_TRUE(config) << config.error();
    const std::atomic<bool> stop{false};
    ASSERT_TRUE(RunRig(config.value(), {.out = folder.path(), .write_views = true}, stop));
    const auto quality =
        Evaluate({.units = {{{{.in = clip, .out = folder / "tractor.avi"}, {}}}}, .step = 24});
    ASSERT_TRUE(quality) << quality.error();
    const json& view = quality.value().figures["units"]["tractor"];
    EXPECT_LE(view["jerk_out_px"].get<double>(), GetParam().jerk_px);
    EXPECT_GE(view["stability"].get<double>(), GetParam().stability);
    EXPECT_EQ(view["frames_lost"], 0);
    EXPECT_EQ(view["frames_repeated"], 0);
}

const char* const kFree = "lookahead_frames: 0, border: free";
const char* const kCovered5 = "lookahead_frames: 5, border: covered, cropping: 0.90";
INSTANTIATE_TEST_SUITE_P(
    Clips, ClipTest,
    testing::Values(Clip{"video-1", kFree, 0.35, 0.82}, Clip{"video-3", kFree, 0.20, 0.86},
                    Clip{"video-10", kFree, 0.55, 0.87}, Clip{"video-1", kCovered5, 1.0, 0},
                    Clip{"video-3", kCovered5, 0.50, 0}, Clip{"video-10", kCovered5, 0.80, 0}));

}  // namespace
}  // namespace hitchview::app
