#include <gtest/gtest.h>

#include "algo/exposure_gains.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/sine_texture.hpp"
#include "tests/support/small_ring.hpp"

namespace hitchview::algo {
namespace {

using tests::Nv12Picture;

constexpr int kWidth = 320;
constexpr int kHeight = 200;
constexpr int kApart = 140;

/// Two plane cameras of one scene, the trailer's 140 px to the right and darker by a gain.
class ExposureGainsTest : public testing::Test {
 protected:
    ExposureGainsTest() {
        for (const Unit unit : kUnits) rig_[unit] = UnitGeometry::Plane(kWidth, kHeight);
        map_.emplace(Projection::Plane(kWidth + kApart, kHeight), rig_, SeamOptions{});
        Composition composition;
        composition.M_canvas_view[Unit::kTrailer](0, 2) = kApart;
        SerialRunner runner;
        map_->Build(composition, runner);
    }

    /// Shows one pair of pictures a number of times; the trailer's is `gain` times as bright.
    void Show(ExposureGains& gains, double gain, int times = 1, bool trailer_present = true) const {
        const tests::SineTexture world(3, 30, 120);
        cv::Mat1b dark;
        world.Shifted({kWidth, kHeight}, -kApart, 0).convertTo(dark, CV_8U, gain);
        const Nv12Picture tractor(world.Shifted({kWidth, kHeight}, 0, 0));
        const Nv12Picture trailer(dark);
        RigFrames frames;
        frames[Unit::kTractor][0] = tractor.frame();
        if (trailer_present) frames[Unit::kTrailer][0] = trailer.frame();
        for (int i = 0; i < times; ++i) gains.Update(*map_, frames);
    }
    static double Ratio(const ExposureGains& gains) {
        return gains.gains()[Unit::kTrailer][0] / gains.gains()[Unit::kTractor][0];
    }

    PerUnit<std::optional<UnitGeometry>> rig_;
    std::optional<ComposedMap> map_;
};

TEST_F(ExposureGainsTest, ADarkerCameraIsBrightenedAndTheOtherDarkenedToMeet) {
    for (const double gain : {0.8, 0.6, 1.0, 1.25}) {
        ExposureGains gains;
        Show(gains, gain);
        EXPECT_NEAR(Ratio(gains) * gain, 1, 0.03) << gain;
        const CameraGains found = gains.gains();
        EXPECT_NEAR(found[Unit::kTrailer][0] * found[Unit::kTractor][0], 1, 1e-3) << gain;
        EXPECT_EQ(found[Unit::kTrailer][1], 1.0F) << "a camera that nobody overlaps";
    }
}

TEST_F(ExposureGainsTest, AChangeIsFollowedSlowly) {
    ExposureGains gains(0.1);
    Show(gains, 1.0);
    Show(gains, 0.8);
    EXPECT_NEAR(std::log(Ratio(gains)), 0.1 * std::log(1 / 0.8), 0.01);
    Show(gains, 0.8, 60);
    EXPECT_NEAR(Ratio(gains) * 0.8, 1, 0.03);
}

TEST_F(ExposureGainsTest, WithoutASharedPictureTheGainsStayAndResetMakesThemOne) {
    ExposureGains gains;
    Show(gains, 0.8);
    const double before = Ratio(gains);
    Show(gains, 0.8, 1, false);
    EXPECT_EQ(Ratio(gains), before);
    gains.Reset();
    EXPECT_EQ(Ratio(gains), 1);
}

TEST(ExposureGainsRingTest, APlaceThatALensPutsBeyondAllPixelsIsNotRead) {
    const Projection canvas = Projection::Cylinder(1024, 512, 0.5);
    auto cameras = tests::LevelCameras(3, 0.3, 0);
    for (CameraGeometry& camera : cameras) {
        // At its edge it tells of pixels beyond the range of int.
        camera.model.kind = CameraModel::Kind::kPinholeRadtan;
        camera.model.fx_px = camera.model.fy_px = 1000;
        camera.model.distortion = {0, 0, 0, 0, 0.05};
        camera.model.max_theta_rad = 1.57;
    }
    PerUnit<std::optional<UnitGeometry>> rig;
    rig[Unit::kTractor] = UnitGeometry::Ring(canvas, cameras, {});
    ComposedMap map(canvas, rig, {});
    SerialRunner runner;
    map.Build({}, runner);
    float furthest = 0;
    for (int row = 0; row <= map.block_rows(); ++row) {
        for (int col = 0; col <= map.block_cols(); ++col)
            if (map.corner(0, row, col).sees)
                furthest = std::max(furthest, std::abs(map.corner(0, row, col).x));
    }
    ASSERT_GT(furthest, 4e9F);
    const Nv12Picture picture(cv::Mat1b(200, 320, std::uint8_t{100}));
    RigFrames frames;
    frames[Unit::kTractor].fill(picture.frame());
    ExposureGains gains;
    for (int i = 0; i < 20; ++i) gains.Update(map, frames);
    const CameraGains found = gains.gains();
    for (const float gain : found[Unit::kTractor]) EXPECT_NEAR(gain, 1, 0.01);
}

}  // namespace
}  // namespace hitchview::algo
