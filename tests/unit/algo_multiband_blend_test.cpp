#include <gtest/gtest.h>

#include <cmath>

#include "algo/multiband_blend.hpp"
#include "algo/panorama_renderer.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::algo {
namespace {

using tests::Nv12Picture;
using tests::PanoramaPicture;

constexpr int kWidth = 240;
constexpr int kHeight = 96;
constexpr int kApart = 120;  // the overlap is 120..239, the seam lies in its middle
constexpr int kSeam = 180;
const CameraGains kNoGains = [] {
    CameraGains gains;
    for (const Unit unit : kUnits) gains[unit].fill(1);
    return gains;
}();

/// Two plane cameras, the trailer's to the right.
class MultibandBlendTest : public testing::Test {
 protected:
    explicit MultibandBlendTest(double trailer_down_px = 0) {
        for (const Unit unit : kUnits) rig_[unit] = UnitGeometry::Plane(kWidth, kHeight);
        composition_.M_canvas_view[Unit::kTrailer](0, 2) = kApart;
        composition_.M_canvas_view[Unit::kTrailer](1, 2) = trailer_down_px;
        map_.emplace(canvas_, rig_, SeamOptions{});
        SerialRunner runner;
        map_->Build(composition_, runner);
    }

    PanoramaPicture Blend(const Nv12Picture& tractor, const Nv12Picture& trailer,
                          const CameraGains& gains = kNoGains) {
        RigFrames frames;
        frames[Unit::kTractor][0] = tractor.frame();
        frames[Unit::kTrailer][0] = trailer.frame();
        SerialRunner runner;
        MultibandBlend bands(*map_);
        bands.Update(*map_, {frames, gains}, runner);
        PanoramaRenderer renderer;
        renderer.SetGains(gains);
        PanoramaPicture sharp({canvas_.width_px, canvas_.height_px});
        renderer.Render(*map_, frames, NoData::kPattern, sharp.planes(), runner);
        sharp_.emplace(sharp);
        PanoramaPicture blended({canvas_.width_px, canvas_.height_px});
        renderer.RenderBlended(*map_, frames, bands, blended.planes(), runner);
        return blended;
    }

    static Nv12Picture Grey(std::uint8_t grey, std::uint8_t u = 128, std::uint8_t v = 128) {
        return Nv12Picture(cv::Mat1b(kHeight, kWidth, grey), u, v);
    }

    Projection canvas_ = Projection::Plane(kWidth + kApart, kHeight);
    PerUnit<std::optional<UnitGeometry>> rig_;
    Composition composition_;
    std::optional<ComposedMap> map_;
    std::optional<PanoramaPicture> sharp_;  ///< of the last Blend: by the map's weights alone
};

class ShiftedDownTest : public MultibandBlendTest {
 protected:
    ShiftedDownTest() : MultibandBlendTest(32) {}
};

double LargestStep(const cv::Mat1b& row) {
    double largest = 0;
    for (int x = 1; x < row.cols; ++x)
        largest = std::max(largest, std::abs(1.0 * row(0, x) - row(0, x - 1)));
    return largest;
}

TEST_F(MultibandBlendTest, TwoCamerasThatShowTheSameGiveThatPicture) {
    const tests::SineTexture world(3, 30, 220);
    const PanoramaPicture blended =
        Blend(Nv12Picture(world.Shifted({kWidth, kHeight}, 0, 0)),
              Nv12Picture(world.Shifted({kWidth, kHeight}, -kApart, 0)));
    EXPECT_LE(cv::norm(blended.y(), sharp_->y(), cv::NORM_INF), 1);
}

TEST_F(MultibandBlendTest, AStepBetweenTwoFlatPicturesBecomesAWideSlope) {
    const PanoramaPicture blended = Blend(Grey(60, 100, 140), Grey(140, 120, 110));
    const cv::Mat1b row = blended.y().row(40);
    EXPECT_GT(LargestStep(sharp_->y().row(40)), 4);
    EXPECT_LT(LargestStep(row), 2.5);
    EXPECT_NEAR(row(0, kSeam), 100, 4);
    for (int x = 1; x < row.cols; ++x) ASSERT_GE(row(0, x), row(0, x - 1)) << x;
    EXPECT_EQ(row(0, kSeam - 80), 60) << "nothing changes far from the seam";
    EXPECT_EQ(row(0, kSeam + 80), 140);
    EXPECT_GT(row(0, kSeam - 24), 62) << "though the map gives all to one camera here";
    EXPECT_NEAR(blended.u()(20, kSeam / 2), 110, 2);
    EXPECT_NEAR(blended.v()(20, kSeam / 2), 125, 2);
    EXPECT_EQ(blended.u()(20, 20), 100);
}

TEST_F(MultibandBlendTest, AStepIsBlendedLikeAGaussianOfTheCoarsestBand) {
    const PanoramaPicture blended = Blend(Grey(60), Grey(140));
    // Three blurs by (1 2 1) with 1, 2 and 4 blocks between the taps, and the map's own strip.
    const double variance_px2 = 64 * (1 + 4 + 16) * 0.5 + 8.0 * 8.0 / 5;
    for (int x = kSeam - 60; x <= kSeam + 60; x += 4) {
        const double beyond = (x - 179.5) / std::sqrt(2 * variance_px2);
        EXPECT_NEAR(blended.y()(40, x), 100 + 40 * std::erf(beyond), 3) << x;
    }
}

TEST_F(MultibandBlendTest, FineDetailDoesNotLeaveTheNarrowStrip) {
    cv::Mat1b lines(kHeight, kWidth);
    for (int x = 0; x < kWidth; ++x) lines.col(x) = x % 4 < 2 ? 60 : 140;
    const PanoramaPicture blended = Blend(Nv12Picture(lines), Grey(100));
    for (int x = kSeam + 12; x < kSeam + 60; ++x)
        EXPECT_NEAR(blended.y()(40, x), 100, 2) << "no ghost of the lines, " << x;
    for (int x = kSeam - 60; x < kSeam - 12; ++x)
        EXPECT_NEAR(blended.y()(40, x), x % 4 < 2 ? 60 : 140, 3) << "and all of them here, " << x;
}

TEST_F(ShiftedDownTest, WhereOnlyOneCameraSeesItsPictureStaysAsItIs) {
    const PanoramaPicture blended = Blend(Grey(60), Grey(140));
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(blended.y()(12, x), 60) << "tractor alone, " << x;
    EXPECT_EQ(blended.y()(12, 300), 0) << "nobody";
    EXPECT_EQ(blended.y()(85, 110), 60) << "far from the seam";
    EXPECT_GT(blended.y()(80, kSeam - 24), 62) << "both see it";
}

TEST_F(MultibandBlendTest, ACameraWithoutAPictureHasNoWeight) {
    RigFrames frames;
    const Nv12Picture trailer = Grey(140);
    frames[Unit::kTrailer][0] = trailer.frame();
    SerialRunner runner;
    map_->Build(composition_, {frames, kNoGains}, runner);
    MultibandBlend bands(*map_);
    bands.Update(*map_, {frames, kNoGains}, runner);
    PanoramaPicture blended({canvas_.width_px, canvas_.height_px});
    PanoramaRenderer().RenderBlended(*map_, frames, bands, blended.planes(), runner);
    for (int x = kApart; x < canvas_.width_px; ++x) ASSERT_EQ(blended.y()(40, x), 140) << x;
    EXPECT_TRUE(blended.y()(40, 60) == 40 || blended.y()(40, 60) == 72) << "hatched";
}

TEST_F(MultibandBlendTest, GainsCountBeforeThePicturesAreCompared) {
    CameraGains gains = kNoGains;
    gains[Unit::kTractor][0] = 1.5F;
    const PanoramaPicture blended = Blend(Grey(80), Grey(120), gains);
    EXPECT_EQ(cv::countNonZero(blended.y() != 120), 0);
}

}  // namespace
}  // namespace hitchview::algo
