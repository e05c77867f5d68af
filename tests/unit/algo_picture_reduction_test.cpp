#include <gtest/gtest.h>

#include <numbers>

#include "algo/panorama_renderer.hpp"
#include "algo/picture_reduction.hpp"
#include "tests/support/camera_picture.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/small_ring.hpp"

namespace hitchview::algo {
namespace {

using tests::CameraPicture;
using tests::PanoramaPicture;

using Rig = PerUnit<std::optional<UnitGeometry>>;

/// One level camera with 150 px per radian, `wider_px` more than the ring's others.
Rig OneCamera(const Projection& canvas, int wider_px = 0) {
    Rig rig;
    std::vector<CameraGeometry> cameras = tests::LevelCameras(1, 0, 0);
    cameras[0].model.width_px += wider_px;
    cameras[0].model.height_px += wider_px;
    rig[Unit::kTractor] = UnitGeometry::Ring(canvas, cameras, {});
    return rig;
}

Projection RingOf(int width_px) {
    return Projection::Cylinder(width_px, width_px / 6 * 2, 0.5);
}

RigFrames Alone(const CameraFrame& frame) {
    RigFrames frames;
    frames[Unit::kTractor][0] = frame;
    return frames;
}

TEST(PictureReductionTest, ACameraIsReducedToAboutThePixelsOfTheCanvas) {
    const auto side = [](int canvas_px) {
        return PictureReduction(OneCamera(RingOf(canvas_px))).side(Unit::kTractor, 0);
    };
    EXPECT_EQ(side(1024), 1) << "0.9 camera pixels to one of the canvas";
    EXPECT_EQ(side(660), 1) << "1.4";
    EXPECT_EQ(side(480), 2) << "2";
    EXPECT_EQ(side(240), 4) << "4";
    EXPECT_EQ(side(120), 4) << "as far as it goes";
}

TEST(PictureReductionTest, APlaneIsNeverReduced) {
    Rig rig;
    rig[Unit::kTrailer] = UnitGeometry::Plane(1280, 720);
    EXPECT_EQ(PictureReduction(rig).side(Unit::kTrailer, 0), 1);
}

class ReducedFormatTest : public testing::TestWithParam<PixelLayout> {};

/// Mean of a box of samples, rounded.
int MeanOf(const SamplePlane& plane, int x, int y, int across, int down) {
    int sum = across * down / 2;
    for (int v = 0; v < down; ++v) {
        for (int u = 0; u < across; ++u)
            sum += plane.row(y * down + v)[(x * across + u) * plane.step_bytes];
    }
    return sum / (across * down);
}

TEST_P(ReducedFormatTest, EverySampleIsTheMeanOfThoseItStandsFor) {
    for (const int canvas_px : {480, 240}) {
        const Rig rig = OneCamera(RingOf(canvas_px), 6);
        PictureReduction reduction(rig);
        const int side = reduction.side(Unit::kTractor, 0);
        const auto picture =
            CameraPicture::Textured({326, 206}, GetParam(), SampleRange::kLimited, 3);
        SerialRunner runner;
        const CameraFrame whole = picture.frame();
        const CameraFrame reduced = reduction.Update(Alone(whole), runner)[Unit::kTractor][0];
        EXPECT_EQ(reduced.side, side);
        EXPECT_EQ(reduced.width_px, side == 2 ? 162 : 80) << "even";
        EXPECT_EQ(reduced.height_px, side == 2 ? 102 : 50);
        EXPECT_EQ(reduced.range, SampleRange::kLimited);
        ASSERT_EQ(reduced.has_chroma(), whole.has_chroma());
        const SamplePlane luma = reduced.LumaSamples();
        for (int y = 0; y < luma.rows; ++y) {
            for (int x = 0; x < luma.cols; ++x)
                ASSERT_EQ(luma.row(y)[x], MeanOf(whole.LumaSamples(), x, y, side, side));
        }
        if (!whole.has_chroma()) continue;
        for (const int channel : {0, 1}) {
            const SamplePlane from = whole.ChromaSamples(channel);
            const SamplePlane to = reduced.ChromaSamples(channel);
            const int down = side * from.rows / (whole.height_px / 2);
            for (int y = 0; y < to.rows; ++y) {
                for (int x = 0; x < to.cols; ++x)
                    ASSERT_EQ(to.row(y)[x * to.step_bytes], MeanOf(from, x, y, side, down));
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Layouts, ReducedFormatTest,
                         testing::Values(PixelLayout::kNv12, PixelLayout::kUyvy, PixelLayout::kYuyv,
                                         PixelLayout::kGrey));

TEST(PictureReductionTest, AMissingPictureStaysMissingAndOthersArePassedOn) {
    const Rig rig = OneCamera(RingOf(1024));
    const auto picture =
        CameraPicture::Textured({320, 200}, PixelLayout::kUyvy, SampleRange::kFull, 3);
    SerialRunner runner;
    PictureReduction fine(rig);
    EXPECT_EQ(fine.Update(Alone(picture.frame()), runner)[Unit::kTractor][0].luma,
              picture.frame().luma);
    PictureReduction coarse(OneCamera(RingOf(240)));
    coarse.Update(Alone(picture.frame()), runner);
    EXPECT_FALSE(coarse.Update(Alone({}), runner)[Unit::kTractor][0].present());
}

/// What is reduced must be drawn where it was: a slope shows a shift by a tenth of a pixel.
TEST(PictureReductionTest, TheReducedPictureIsDrawnInItsPlace) {
    const Projection canvas = RingOf(240);
    const Rig rig = OneCamera(canvas);
    cv::Mat1b luma(200, 320);
    for (int y = 0; y < luma.rows; ++y) {
        for (int x = 0; x < luma.cols; ++x)
            luma(y, x) = static_cast<std::uint8_t>((x * 3 + y * 5) / 8);
    }
    tests::Nv12Picture picture(luma);
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 160; ++x) {
            picture.chroma()(y, 2 * x) = static_cast<std::uint8_t>(x);
            picture.chroma()(y, 2 * x + 1) = static_cast<std::uint8_t>(2 * y);
        }
    }
    SerialRunner runner;
    ComposedMap map(canvas, rig, {});
    map.Build({}, runner);
    const auto drawn = [&](const RigFrames& frames) {
        PanoramaPicture panorama({canvas.width_px, canvas.height_px});
        PanoramaRenderer().Render(map, frames, NoData::kBlack, panorama.planes(), runner);
        return panorama;
    };
    PictureReduction reduction(rig);
    const PanoramaPicture whole = drawn(Alone(picture.frame()));
    const PanoramaPicture reduced = drawn(reduction.Update(Alone(picture.frame()), runner));
    int compared = 0;
    for (int y = 0; y < canvas.height_px; ++y) {
        for (int x = 0; x < canvas.width_px; ++x) {
            // The outermost pixels of the smaller picture lie farther inside.
            if (whole.y()(y, x) == 0 || reduced.y()(y, x) == 0) continue;
            EXPECT_NEAR(whole.y()(y, x), reduced.y()(y, x), 1) << x << ' ' << y;
            ++compared;
            const bool edge = reduced.u()(y / 2, x / 2) == 128;
            if (edge) continue;
            EXPECT_NEAR(whole.u()(y / 2, x / 2), reduced.u()(y / 2, x / 2), 2) << x << ' ' << y;
            EXPECT_NEAR(whole.v()(y / 2, x / 2), reduced.v()(y / 2, x / 2), 2) << x << ' ' << y;
        }
    }
    EXPECT_GT(compared, 2000);
}

}  // namespace
}  // namespace hitchview::algo
