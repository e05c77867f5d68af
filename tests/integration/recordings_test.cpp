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
        const std::string file = tests::WriteText(
            folder_ / "rig.yaml",
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

TEST_P(HandheldTest, IsSteadierByTwoThirdsAndItsSeamFits) {
    const std::string folder = "pairs/" + GetParam() + "/";
    Run({folder + "tractor.avi", folder + "trailer.avi", "1100, 640"}, true);
    if (IsSkipped() || HasFailure()) return;
    EXPECT_EQ(summary_.frames, 240U);
    const json figures = Measure();
    EXPECT_EQ(figures["frames"], 240);
    ExpectSteadier(figures, 1.0 / 3);
    EXPECT_LT(figures["seams"]["right"]["median_px"].get<double>(), 1.5);
}

INSTANTIATE_TEST_SUITE_P(Pairs, HandheldTest, testing::Values("handheld-1", "handheld-10"));

TEST_F(RecordingsTest, ADriveWithParallaxIsSteadierByHalf) {
    Run({"pairs/stereo-drive-1/tractor.avi", "pairs/stereo-drive-1/trailer.avi", "1280, 480"},
        true);
    if (IsSkipped() || HasFailure()) return;
    EXPECT_EQ(summary_.frames, 51U);
    ExpectSteadier(Measure(), 0.5);
}

TEST_F(RecordingsTest, TheSeamOfTwoPhonesIsFoundAndKept) {
    Run({"pairs/rooftop/left.mp4", "pairs/rooftop/right.mp4", "800, 720"}, false);
    if (IsSkipped() || HasFailure()) return;
    EXPECT_EQ(summary_.frames, 296U);
    EXPECT_GT(LockedShare(), 0.9);
}

}  // namespace
}  // namespace hitchview::app
