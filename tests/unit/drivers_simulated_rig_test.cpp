#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "drivers/simulated_rig.hpp"
#include "tests/support/simulated_pictures.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using tests::Rendered;
using tests::Rig;
using Image = std::vector<std::uint8_t>;

constexpr double kDegree = std::numbers::pi / 180;

SimulationOptions Small() {
    SimulationOptions options;
    options.frames = 90;
    options.width_px = 192;
    options.height_px = 108;
    options.noise_sigma = 0;
    options.gain_spread = 0;
    return options;
}

double MeanDifference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
    return sum / static_cast<double>(a.size());
}

double LumaAt(const SimulatedRig& rig, const Image& image, const Vector2d& pixel) {
    const auto x = static_cast<std::size_t>(std::lround(pixel.x()));
    const auto y = static_cast<std::size_t>(std::lround(pixel.y()));
    return image[y * static_cast<std::size_t>(rig.options().width_px) + x];
}

TEST(SimulatedRigGeometryTest, CamerasHaveTheNamesAndUnitsOfTheRig) {
    std::string names;
    for (const auto& camera : SimulatedRigGeometry(1280, 720)) {
        names += std::string(camera.name) + (camera.unit == algo::Unit::kTractor ? "A " : "B ");
    }
    EXPECT_EQ(names, "frontA left_frontA right_frontA leftB left_rearB rearB right_rearB rightB ");
}

TEST(SimulatedRigGeometryTest, EachLensSeesAHundredAndTwentyDegreesAtEverySize) {
    for (const auto& [width, height] : {std::pair{1280, 720}, {640, 360}, {320, 320}}) {
        const algo::CameraModel lens = SimulatedRigGeometry(width, height)[0].geometry.model;
        const auto left = lens.Unproject({-0.5, lens.cy_px});
        const auto right = lens.Unproject({width - 0.5, lens.cy_px});
        ASSERT_TRUE(left && right);
        EXPECT_NEAR(std::acos(left->dot(*right)) / kDegree, 120, 1e-6);
        EXPECT_TRUE(lens.Unproject({0, 0}));
    }
}

TEST(SimulatedRigGeometryTest, TheSideCamerasAreNearEachOtherAcrossTheHitch) {
    const auto table = SimulatedRigGeometry(1280, 720);
    const auto at = [&](std::size_t i) { return table[i].geometry.T_unit_camera.translation(); };
    EXPECT_LE((at(1) - at(3)).norm(), 2.0);
    EXPECT_LE((at(2) - at(7)).norm(), 2.0);
}

TEST(SimulatedRigGeometryTest, EveryDirectionButStraightAheadIsSeenByTwoCameras) {
    const auto table = SimulatedRigGeometry(1280, 720);
    for (int azimuth = 0; azimuth < 360; ++azimuth) {
        const Vector3d far{1e6 * std::cos(azimuth * kDegree), 1e6 * std::sin(azimuth * kDegree), 0};
        const auto seen_by = std::count_if(table.begin(), table.end(), [&](const auto& camera) {
            const auto pixel =
                camera.geometry.model.Project(camera.geometry.T_unit_camera.inverse() * far);
            return pixel && pixel->x() >= 0 && pixel->x() < 1280 && pixel->y() >= 0 &&
                   pixel->y() < 720;
        });
        EXPECT_GE(seen_by, azimuth < 12 || azimuth > 348 ? 1 : 2) << azimuth;
    }
}

TEST(SimulatedRigTest, AWrongOptionIsRefusedWithItsName) {
    SimulationOptions options = Small();
    options.speed_mps = -1;
    const auto rig_result = SimulatedRig::Create(options);
    ASSERT_FALSE(rig_result.ok());
    EXPECT_NE(rig_result.error().find("speed_mps"), std::string::npos);
}

TEST(SimulatedRigTest, AFrameRenderedTwiceByAnyNumberOfThreadsIsBitIdentical) {
    SimulationOptions options = Small();
    options.noise_sigma = 2;
    options.render_threads = 1;
    const auto one = Rig(options);
    options.render_threads = 3;
    const auto three = Rig(options);
    const Image image = Rendered(*one, 5, 20);
    EXPECT_EQ(image, Rendered(*one, 5, 20));
    EXPECT_EQ(image, Rendered(*three, 5, 20));
}

TEST(SimulatedRigTest, TheSeedDecidesTheWorld) {
    SimulationOptions options = Small();
    const auto first = Rig(options);
    EXPECT_EQ(Rendered(*first, 1, 7), Rendered(*Rig(options), 1, 7));
    options.seed = 2;
    EXPECT_GT(MeanDifference(Rendered(*first, 1, 7), Rendered(*Rig(options), 1, 7)), 5);
}

TEST(SimulatedRigTest, GainScalesTheImageAndNoiseHasItsSigma) {
    SimulationOptions options = Small();
    const auto plain = Rig(options);
    options.gain_spread = 0.3;
    const auto bright = Rig(options);
    options.gain_spread = 0;
    options.noise_sigma = 3;
    const auto noisy = Rig(options);
    const Image a = Rendered(*plain, 2, 5);
    const Image b = Rendered(*bright, 2, 5);
    const Image c = Rendered(*noisy, 2, 5);
    double noise_power = 0;
    int samples = 0;
    for (std::size_t i = 0; i < 192 * 108; ++i) {
        if (a[i] < 15 || a[i] > 180) continue;
        EXPECT_NEAR(b[i], a[i] * bright->GainOf(2), 1.5);
        noise_power += (c[i] - a[i]) * (c[i] - a[i]);
        ++samples;
    }
    ASSERT_GT(samples, 5000);
    EXPECT_NE(bright->GainOf(2), bright->GainOf(3));
    EXPECT_NEAR(std::sqrt(noise_power / samples), 3, 0.2);
}

TEST(SimulatedRigTest, APixelsWorldPointProjectsBackToIt) {
    const auto rig = Rig(Small());
    for (int camera = 0; camera < SimulatedRig::kCameras; ++camera) {
        for (double x = 5; x < 190; x += 37) {
            for (double y = 4; y < 106; y += 21) {
                const auto seen = rig->WorldPointAt(camera, 33, {x, y});
                ASSERT_TRUE(seen);
                const auto pixel = rig->ProjectWorldPoint(camera, 33, seen->p_world_m,
                                                          SimulatedRig::Occlusion::kTested);
                ASSERT_TRUE(pixel) << camera << ' ' << x << ' ' << y;
                EXPECT_LT((*pixel - Vector2d(x, y)).norm(), 1e-6);
            }
        }
    }
}

TEST(SimulatedRigTest, APointBehindSomethingIsOccluded) {
    const auto rig = Rig(Small());
    const auto seen = rig->WorldPointAt(0, 0, {96, 100});
    ASSERT_TRUE(seen);
    ASSERT_LT(seen->distance_m, 20);  // the ground
    const Vector3d eye = rig->CameraPoseAt(0, 0).translation();
    const Vector3d behind = eye + 1.5 * (seen->p_world_m - eye);
    EXPECT_TRUE(rig->ProjectWorldPoint(0, 0, behind));
    EXPECT_FALSE(rig->ProjectWorldPoint(0, 0, behind, SimulatedRig::Occlusion::kTested));
}

TEST(SimulatedRigTest, PixelsBelowTheHorizonMeetTheGroundOrStandOnIt) {
    const auto rig = Rig(Small());
    for (double x = 3; x < 190; x += 11) {
        const auto seen = rig->WorldPointAt(5, 10, {x, 104});
        ASSERT_TRUE(seen);
        EXPECT_GT(seen->p_world_m.z(), -1e-3);
        EXPECT_LT(seen->p_world_m.z(), 4);
    }
}

// Rendering culls by tile, the ground truth casts one ray through the whole scene: both must see
// the same. Cameras of the two units look at the same far point from different places.
TEST(SimulatedRigTest, AFarPointHasTheSameBrightnessInBothUnits) {
    SimulationOptions options = Small();
    options.width_px = 640;
    options.height_px = 360;
    const auto rig = Rig(options);
    const Image left_front = Rendered(*rig, 1, 40);
    const Image left = Rendered(*rig, 3, 40);
    int compared = 0;
    int alike = 0;
    for (double x = 10; x < 630; x += 9) {
        for (double y = 10; y < 200; y += 9) {
            const auto seen = rig->WorldPointAt(1, 40, {x, y});
            if (!seen || seen->distance_m < 60) continue;
            const auto pixel =
                rig->ProjectWorldPoint(3, 40, seen->p_world_m, SimulatedRig::Occlusion::kTested);
            if (!pixel) continue;
            ++compared;
            const double difference = LumaAt(*rig, left_front, {x, y}) - LumaAt(*rig, left, *pixel);
            alike += std::abs(difference) < 16 ? 1 : 0;
        }
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(alike, 0.9 * compared);
}

TEST(SimulatedRigTest, ShakingOneUnitLeavesTheImagesOfTheOtherAlone) {
    SimulationOptions options = Small();
    const auto shaken = Rig(options);
    options.shake[algo::Unit::kTractor].scale = 0;
    const auto tractor_held = Rig(options);
    EXPECT_NE(Rendered(*shaken, 0, 11), Rendered(*tractor_held, 0, 11));
    EXPECT_EQ(Rendered(*shaken, 4, 11), Rendered(*tractor_held, 4, 11));
}

TEST(SimulatedRigTest, TheWorldIsRichInGradientsEverywhere) {
    const auto rig = Rig(Small());
    for (int camera = 0; camera < SimulatedRig::kCameras; ++camera) {
        const Image image = Rendered(*rig, camera, 0);
        double gradient = 0;
        for (std::size_t i = 0; i + 1 < 192 * 108; ++i)
            gradient += std::abs(image[i + 1] - image[i]);
        EXPECT_GT(gradient / (192 * 108), 3) << camera;
    }
}

}  // namespace
}  // namespace hitchview::drivers
