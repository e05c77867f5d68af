#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/report.hpp"
#include "drivers/replay_camera.hpp"
#include "tests/support/plane_rig_files.hpp"
#include "tests/support/shown_panoramas.hpp"

namespace hitchview::app {
namespace {

using algo::Unit;
using Eigen::Vector2d;
using tests::KeptPanorama;
using tests::PlaneRigFiles;
using tests::RunAndKeep;

constexpr const char* kUnsteady = "stabilization: {enabled: false}\n";
constexpr const char* kUnstitched = "stitching: {enabled: false}\n";

const cv::Size kSize = PlaneRigFiles::kSize;
const cv::Size kCanvas = PlaneRigFiles::kCanvas;

/// Pixel of a unit's frame that a canvas pixel shows.
Vector2d ViewPixel(const KeptPanorama& shown, Unit unit, int x, int y) {
    const Eigen::Matrix3d& M = shown.composition.M_canvas_view[unit];
    return (M.inverse() * Eigen::Vector3d(x, y, 1)).hnormalized();
}

bool Inside(const Vector2d& pixel) {
    constexpr double kRim_px = 2;
    return pixel.x() > kRim_px && pixel.y() > kRim_px && pixel.x() < kSize.width - 1 - kRim_px &&
           pixel.y() < kSize.height - 1 - kRim_px;
}

struct Deviation {
    int pixels = 0;
    double mean_grey = 0;
};

/// Of the panorama from the world that the tractor says it shows, where both units see it.
Deviation InTheOverlap(const KeptPanorama& shown, const PlaneRigFiles& rig, int frame) {
    Deviation deviation;
    for (int y = 0; y < kCanvas.height; ++y) {
        for (int x = 0; x < kCanvas.width; ++x) {
            const Vector2d in_tractor = ViewPixel(shown, Unit::kTractor, x, y);
            if (!Inside(in_tractor) || !Inside(ViewPixel(shown, Unit::kTrailer, x, y))) continue;
            const double world = rig.WorldAt(Unit::kTractor, frame, in_tractor.x(), in_tractor.y());
            deviation.mean_grey += std::abs(shown.Luma(x, y) - std::clamp(world, 0.0, 255.0));
            ++deviation.pixels;
        }
    }
    if (deviation.pixels > 0) deviation.mean_grey /= deviation.pixels;
    return deviation;
}

/// Canvas pixels that both units see at rest.
constexpr int kOverlapPixels = 100 * 234;

TEST(PlaneRunTest, StillCamerasShowTheOneWorldTheyLookAt) {
    const PlaneRigFiles rig(0);
    const auto kept = RunAndKeep(rig.Rig());
    ASSERT_EQ(kept.size(), PlaneRigFiles::kFrames);
    for (int i = 0; i < PlaneRigFiles::kFrames; ++i) {
        const Deviation deviation = InTheOverlap(kept[static_cast<std::size_t>(i)], rig, i);
        EXPECT_GT(deviation.pixels, 0.9 * kOverlapPixels);
        EXPECT_LT(deviation.mean_grey, 1.5) << "frame " << i;
    }
}

TEST(PlaneRunTest, ShakingCamerasShowTheOneWorldTheyLookAt) {
    const PlaneRigFiles rig(3);
    const auto kept = RunAndKeep(rig.Rig());
    ASSERT_EQ(kept.size(), PlaneRigFiles::kFrames);
    for (int i = 0; i < PlaneRigFiles::kFrames; ++i) {
        const Deviation deviation = InTheOverlap(kept[static_cast<std::size_t>(i)], rig, i);
        EXPECT_GT(deviation.pixels, 0.7 * kOverlapPixels);
        EXPECT_LT(deviation.mean_grey, 4.0) << "frame " << i;
    }
}

/// Canvas position of a corner of a unit's view in the first panorama.
Vector2d CornerOnCanvas(const KeptPanorama& shown, Unit unit, const Vector2d& corner) {
    return (shown.composition.M_canvas_view[unit] * corner.homogeneous()).hnormalized();
}

TEST(PlaneRunTest, TheTwoViewsTogetherAreCentredOnTheCanvas) {
    const PlaneRigFiles rig(0);
    const auto kept = RunAndKeep(rig.Rig(kUnsteady), {.frames = 1});
    ASSERT_EQ(kept.size(), 1U);
    const Vector2d low = CornerOnCanvas(kept[0], Unit::kTractor, {0, 0});
    const Vector2d high =
        CornerOnCanvas(kept[0], Unit::kTrailer, {double(kSize.width), double(kSize.height)});
    const Vector2d middle = 0.5 * (low + high);
    EXPECT_NEAR(middle.x(), 0.5 * kCanvas.width, 1);
    EXPECT_NEAR(middle.y(), 0.5 * kCanvas.height, 1);
    const Vector2d extent = high - low;
    EXPECT_NEAR(extent.x(), 220 + kSize.width, 1);
    EXPECT_NEAR(extent.y(), 6 + kSize.height, 1);
}

TEST(PlaneRunTest, PlacementPutsTheTractorWhereItSaysAndTheTrailerBesideIt) {
    const PlaneRigFiles rig(0);
    const std::string placement = "placement: {tractor: [10, 20], trailer: [230, 26]}\n";
    const auto kept = RunAndKeep(rig.Rig(kUnsteady + placement), {.frames = 2});
    ASSERT_EQ(kept.size(), 2U);
    for (const KeptPanorama& shown : kept) {
        EXPECT_NEAR((CornerOnCanvas(shown, Unit::kTractor, {0, 0}) - Vector2d(10, 20)).norm(), 0,
                    1e-9);
        EXPECT_NEAR((CornerOnCanvas(shown, Unit::kTrailer, {0, 0}) - Vector2d(230, 26)).norm(), 0,
                    0.5);
    }
}

TEST(PlaneRunTest, PlacementHoldsForBothWhereNothingCanBeMatched) {
    const PlaneRigFiles rig = PlaneRigFiles::Flat();
    const auto kept = RunAndKeep(rig.Rig("placement: {tractor: [10, 20], trailer: [290, 40]}\n"));
    ASSERT_EQ(kept.size(), PlaneRigFiles::kFrames);
    EXPECT_EQ(CornerOnCanvas(kept.back(), Unit::kTractor, {0, 0}), Vector2d(10, 20));
    EXPECT_EQ(CornerOnCanvas(kept.back(), Unit::kTrailer, {0, 0}), Vector2d(290, 40));
}

TEST(PlaneRunTest, WithoutTextureTheUnitsStandFlushLeftAndFlushRight) {
    const PlaneRigFiles rig = PlaneRigFiles::Flat();
    const auto kept = RunAndKeep(rig.Rig());
    ASSERT_EQ(kept.size(), PlaneRigFiles::kFrames);
    for (const KeptPanorama& shown : kept) {
        EXPECT_EQ(CornerOnCanvas(shown, Unit::kTractor, {0, 0}), Vector2d(0, 30));
        EXPECT_EQ(CornerOnCanvas(shown, Unit::kTrailer, {0, 0}), Vector2d(320, 30));
        EXPECT_EQ(shown.composition.seams[algo::Overlap::kRight], algo::SeamState::kNoOverlap);
    }
    EXPECT_EQ(kept[0].Luma(5, 150), 120);
    EXPECT_EQ(kept[0].Luma(634, 150), 120);
    EXPECT_EQ(kept[0].Luma(320, 10), 0);
}

TEST(PlaneRunTest, WithEverythingOffTheUnitsStayFlushLeftAndFlushRight) {
    const PlaneRigFiles rig(3);
    const auto kept = RunAndKeep(rig.Rig(std::string(kUnsteady) + kUnstitched));
    ASSERT_EQ(kept.size(), PlaneRigFiles::kFrames);
    for (const KeptPanorama& shown : kept) {
        EXPECT_EQ(CornerOnCanvas(shown, Unit::kTractor, {0, 0}), Vector2d(0, 30));
        EXPECT_EQ(CornerOnCanvas(shown, Unit::kTrailer, {0, 0}), Vector2d(320, 30));
    }
}

TEST(PlaneRunTest, ASeamThatWasNeverFoundIsReportedAsNeverLocked) {
    const PlaneRigFiles rig = PlaneRigFiles::Flat();
    const std::atomic<bool> stop{false};
    const auto summary = RunRig(LoadRigConfig(rig.Rig()).value(), {}, stop);
    ASSERT_TRUE(summary) << summary.error();
    const nlohmann::json report = MakeReport(summary.value(), nullptr);
    EXPECT_EQ(report["seams"]["right"]["locked_share"], 0);
    EXPECT_FALSE(report["seams"].contains("left"));
}

/// Luma of every frame of a video.
std::vector<cv::Mat1b> ReadVideo(const std::string& path) {
    std::vector<cv::Mat1b> frames;
    const auto camera = drivers::ReplayCamera::Open(path, {.name = "read"});
    EXPECT_TRUE(camera) << camera.error();
    if (!camera) return frames;
    while (auto frame = (*camera.value()).WaitFrame(std::chrono::seconds(10))) {
        const hal::FrameView& view = frame->view();
        cv::Mat1b luma(view.format.height_px, view.format.width_px);
        for (int y = 0; y < luma.rows; ++y) {
            std::copy_n(view.planes[0].data + y * view.planes[0].stride_bytes, luma.cols, luma[y]);
        }
        frames.push_back(luma);
    }
    return frames;
}

/// Brightest pixel in columns [from, to).
int Brightest(const cv::Mat1b& picture, int from, int to) {
    const cv::Mat1b part = picture.colRange(from, to);
    return *std::max_element(part.begin(), part.end());
}

class PlaneVideosTest : public testing::TestWithParam<int> {};

TEST_P(PlaneVideosTest, HaveOneFrameForEachSetAndAreBlackWhereThereIsNoData) {
    const PlaneRigFiles rig(0);
    const std::string out = rig.folder() / "out";
    const std::string file =
        rig.Rig(std::string(kUnsteady) + "placement: {tractor: [0, 30], trailer: [220, 36]}\n");
    RunAndKeep(
        file,
        {.out = out, .lookahead_frames = GetParam(), .write_video = true, .write_views = true});

    EXPECT_EQ(ReadVideo(out + "/panorama.avi").size(), PlaneRigFiles::kFrames);
    const auto tractor = ReadVideo(out + "/tractor.avi");
    const auto trailer = ReadVideo(out + "/trailer.avi");
    ASSERT_EQ(tractor.size(), PlaneRigFiles::kFrames);
    ASSERT_EQ(trailer.size(), PlaneRigFiles::kFrames);
    constexpr int kJpegBlock = 16;
    for (std::size_t i = 0; i < tractor.size(); ++i) {
        EXPECT_EQ(Brightest(tractor[i], 320 + kJpegBlock, kCanvas.width), 0);
        EXPECT_GT(Brightest(tractor[i], 0, 320), 150);
        EXPECT_EQ(Brightest(trailer[i], 0, 220 - kJpegBlock), 0);
        EXPECT_GT(Brightest(trailer[i], 220, 540), 150);
    }
}

INSTANTIATE_TEST_SUITE_P(Lookahead, PlaneVideosTest, testing::Values(0, 4));

/// Canvas positions of the middle of the tractor's view.
std::vector<Vector2d> TractorPath(const std::vector<KeptPanorama>& kept) {
    std::vector<Vector2d> path;
    for (const KeptPanorama& shown : kept) {
        path.push_back(
            CornerOnCanvas(shown, Unit::kTractor, {0.5 * kSize.width, 0.5 * kSize.height}));
    }
    return path;
}

TEST(PlaneRunTest, TheRigFileChoosesTheSmoother) {
    const PlaneRigFiles rig(3);
    const auto by_default = TractorPath(RunAndKeep(rig.Rig()));
    const std::string horizon = "stabilization: {smoother: receding_horizon}\n";
    EXPECT_EQ(TractorPath(RunAndKeep(rig.Rig(horizon))), by_default);
    const std::string weights = "stabilization: {smoother: paper_weights}\n";
    const auto paper = TractorPath(RunAndKeep(rig.Rig(weights)));
    ASSERT_EQ(paper.size(), by_default.size());
    EXPECT_GT((paper.back() - by_default.back()).norm(), 0.05);
    // Two outputs at rest, w(1) = .914 and w(2) = .698: 2 lambda (w1 + w2) / (1 + same) of the
    // camera's first motion is taken back.
    const Vector2d motion(3 * (std::sin(2.0) - std::sin(0.3)), 3 * (std::sin(2.9) - std::sin(0.6)));
    EXPECT_LT((paper[1] - paper[0] - 0.7946 * motion).norm(), 0.05);
}

TEST(PlaneRunTest, WithACoveredBorderTwoShakingUnitsFillTheCanvas) {
    const PlaneRigFiles rig(3);
    const auto kept = RunAndKeep(rig.Rig("stabilization: {border: covered, cropping: 0.9}\n"));
    ASSERT_EQ(kept.size(), PlaneRigFiles::kFrames);
    for (const KeptPanorama& shown : kept) {
        const auto is_covered = [&](int x, int y) {
            return Inside(ViewPixel(shown, Unit::kTractor, x, y)) ||
                   Inside(ViewPixel(shown, Unit::kTrailer, x, y));
        };
        for (int x = 0; x < kCanvas.width; ++x) {
            EXPECT_TRUE(is_covered(x, 0) && is_covered(x, kCanvas.height - 1)) << x;
        }
        for (int y = 0; y < kCanvas.height; ++y) {
            EXPECT_TRUE(is_covered(0, y) && is_covered(kCanvas.width - 1, y)) << y;
        }
    }
}

TEST(PlaneRunTest, TheShortestRecordingEndsTheRun) {
    const PlaneRigFiles rig(0);
    std::filesystem::remove(rig.folder() / "trailer/15.png");
    std::filesystem::remove(rig.folder() / "trailer/14.png");
    EXPECT_EQ(RunAndKeep(rig.Rig()).size(), PlaneRigFiles::kFrames - 2);
}

}  // namespace
}  // namespace hitchview::app
