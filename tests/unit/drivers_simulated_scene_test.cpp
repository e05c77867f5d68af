#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "drivers/simulated_rig.hpp"
#include "drivers/simulated_scenario.hpp"
#include "tests/support/simulated_pictures.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using tests::Rendered;
using tests::Rig;
using Image = std::vector<std::uint8_t>;

constexpr int kWidth_px = 160;
constexpr int kHeight_px = 90;
constexpr std::size_t kPixels = static_cast<std::size_t>(kWidth_px) * kHeight_px;
constexpr int kFront = 0;
constexpr int kLeftFront = 1;
constexpr int kLeft = 3;

SimulationOptions SmallScenario(std::string_view name) {
    SimulationOptions options = FindScenario(name)->options;
    options.width_px = kWidth_px;
    options.height_px = kHeight_px;
    return options;
}

double MeanLuma(const Image& image) {
    return std::accumulate(image.begin(), image.begin() + kPixels, 0.0) / kPixels;
}

TEST(SimulatedSceneTest, EachScenarioIsTheSameEveryTime) {
    for (const Scenario& scenario : Scenarios()) {
        SimulationOptions options = SmallScenario(scenario.name);
        options.render_threads = 1;
        const auto one = Rig(options);
        options.render_threads = 3;
        const auto three = Rig(options);
        EXPECT_EQ(Rendered(*one, kLeft, 150), Rendered(*three, kLeft, 150)) << scenario.name;
    }
}

TEST(SimulatedSceneTest, NothingStandsWhereTheVehicleDrives) {
    for (const std::string_view name : {"turn_left_60", "turn_right_60", "reversing", "tunnel"}) {
        const auto rig = Rig(SmallScenario(name));
        for (int frame = 0; frame < rig->options().frames; frame += 60) {
            for (int camera = 0; camera < SimulatedRig::kCameras; ++camera) {
                for (double x = 2; x < kWidth_px; x += 25) {
                    const auto seen = rig->WorldPointAt(camera, frame, {x, kHeight_px / 2.0});
                    ASSERT_TRUE(seen);
                    EXPECT_GT(seen->distance_m, 1.5) << name << ' ' << frame << ' ' << camera;
                }
            }
        }
    }
}

/// Frames in which a thing within the lane on the left is seen in the middle of the picture.
int FramesWithTruck(const SimulatedRig& rig, int camera) {
    int frames = 0;
    for (int frame = 0; frame < rig.options().frames; frame += 5) {
        const auto seen = rig.WorldPointAt(camera, frame, {kWidth_px / 2.0, kHeight_px / 2.0});
        frames += seen && seen->p_world_m.y() > 2 && seen->p_world_m.y() < 5 ? 1 : 0;
    }
    return frames;
}

TEST(SimulatedSceneTest, ATruckPassesTheLeftSideCamerasOneAfterTheOther) {
    const auto rig = Rig(SmallScenario("overtaking_truck"));
    for (const int camera : {kLeft, kLeftFront}) {
        EXPECT_GT(FramesWithTruck(*rig, camera), 10);
        EXPECT_LT(FramesWithTruck(*rig, camera), 30);
    }
    const auto without = Rig(SmallScenario("straight"));
    EXPECT_EQ(FramesWithTruck(*without, kLeft), 0);
}

TEST(SimulatedSceneTest, APixelsWorldPointProjectsBackToItBesideAMovingTruck) {
    const auto rig = Rig(SmallScenario("overtaking_truck"));
    int on_truck = 0;
    for (const int frame : {60, 90, 120, 150}) {
        for (const int camera : {kLeftFront, kLeft}) {
            for (double x = 5; x < kWidth_px; x += 13) {
                for (double y = 4; y < kHeight_px; y += 17) {
                    const auto seen = rig->WorldPointAt(camera, frame, {x, y});
                    ASSERT_TRUE(seen);
                    const auto pixel = rig->ProjectWorldPoint(camera, frame, seen->p_world_m,
                                                              SimulatedRig::Occlusion::kTested);
                    ASSERT_TRUE(pixel) << camera << ' ' << x << ' ' << y;
                    EXPECT_LT((*pixel - Vector2d(x, y)).norm(), 1e-6);
                    on_truck += seen->p_world_m.y() < 5 && seen->p_world_m.z() > 0.1 ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(on_truck, 50);
}

TEST(SimulatedSceneTest, ATruckHidesWhatIsBehindItOnlyWhileItIsThere) {
    const auto rig = Rig(SmallScenario("overtaking_truck"));
    const Vector2d middle{kWidth_px / 2.0, kHeight_px / 2.0};
    const auto truck = rig->WorldPointAt(kLeft, 75, middle);
    ASSERT_TRUE(truck);
    const Vector3d eye = rig->CameraPoseAt(kLeft, 75).translation();
    const Vector3d behind = eye + 2.5 * (truck->p_world_m - eye);
    const auto kTested = SimulatedRig::Occlusion::kTested;
    EXPECT_TRUE(rig->ProjectWorldPoint(kLeft, 75, behind));
    EXPECT_FALSE(rig->ProjectWorldPoint(kLeft, 75, behind, kTested));
    const auto without = Rig(SmallScenario("straight"));
    EXPECT_TRUE(without->ProjectWorldPoint(kLeft, 75, behind, kTested));
}

// The renderer culls by tile and the truth casts one ray: both must see the truck in its place.
TEST(SimulatedSceneTest, TheImageChangesWhereTheTruckIs) {
    const auto with = Rig(SmallScenario("overtaking_truck"));
    const auto without = Rig(SmallScenario("straight"));
    const Image a = Rendered(*with, kLeft, 75);
    const Image b = Rendered(*without, kLeft, 75);
    int changed_on_truck = 0, truck = 0;
    for (int y = 2; y < kHeight_px / 2; y += 3) {
        for (int x = 2; x < kWidth_px; x += 3) {
            const auto i = static_cast<std::size_t>(y * kWidth_px + x);
            const auto p = with->WorldPointAt(kLeft, 75, {x, y});
            const auto q = without->WorldPointAt(kLeft, 75, {x, y});
            ASSERT_TRUE(p && q);
            if (p->p_world_m == q->p_world_m) continue;
            ++truck;
            changed_on_truck += a[i] != b[i] ? 1 : 0;
        }
    }
    EXPECT_GT(truck, 200);
    EXPECT_GT(changed_on_truck, 0.9 * truck);
}

TEST(SimulatedSceneTest, FlakesFallAndOnlyBrightenTheImage) {
    SimulationOptions options = SmallScenario("snow");
    options.noise_sigma = 0;
    for (ShakeOptions& shake : options.shake.of) shake.scale = 0;
    options.speed_mps = 0;
    const auto falling = Rig(options);
    options.scene.snowflakes = 0;
    const auto clear = Rig(options);
    EXPECT_EQ(Rendered(*clear, kLeft, 30), Rendered(*clear, kLeft, 31));
    const Image behind = Rendered(*clear, kLeft, 30);
    const Image late = Rendered(*falling, kLeft, 31);
    const Image early = Rendered(*falling, kLeft, 30);
    int flakes = 0, moved = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        EXPECT_GE(early[i] + 1, std::min<int>(behind[i], 230));
        flakes += early[i] > behind[i] + 8 ? 1 : 0;
        moved += std::abs(early[i] - late[i]) > 8 ? 1 : 0;
    }
    EXPECT_GT(flakes, 50);
    EXPECT_LT(flakes, 5000);
    EXPECT_GT(moved, 50);
}

TEST(SimulatedSceneTest, GroundUnderSnowIsWhiteAndAPlainYardHasNoTexture) {
    const auto gradient = [](const Image& image) {
        double sum = 0;
        for (std::size_t i = kPixels * 3 / 4; i + 1 < kPixels; ++i)
            sum += std::abs(image[i + 1] - image[i]);
        return sum / (static_cast<double>(kPixels) / 4);
    };
    SimulationOptions options = SmallScenario("textureless_yard");
    options.noise_sigma = 0;
    const auto yard = Rig(options);
    const auto road = Rig(SmallScenario("straight"));
    const auto snow = Rig(SmallScenario("snow"));
    EXPECT_LT(gradient(Rendered(*yard, kFront, 90)), 1);
    EXPECT_GT(gradient(Rendered(*road, kFront, 90)), 5);
    EXPECT_GT(MeanLuma(Rendered(*snow, kFront, 90)), 150);
}

TEST(SimulatedSceneTest, NightIsDarkButForTheLamps) {
    SimulationOptions options = SmallScenario("night");
    options.noise_sigma = 0;
    const auto rig = Rig(options);
    for (const int camera : {kFront, kLeftFront, kLeft}) {
        const Image image = Rendered(*rig, camera, 150);
        EXPECT_LT(MeanLuma(image), 90) << camera;
        EXPECT_GT(*std::max_element(image.begin(), image.begin() + kPixels), 120) << camera;
    }
}

TEST(SimulatedSceneTest, ExposureFollowsTheTunnelLate) {
    const auto rig = Rig(SmallScenario("tunnel"));
    const auto gain = [&](int frame) { return rig->GainAt(kLeft, frame) / rig->GainOf(kLeft); };
    const auto first_beyond = [&](double x_m) {
        int frame = 0;
        while (rig->CameraPoseAt(kLeft, frame).translation().x() < x_m) ++frame;
        return frame;
    };
    const int in = first_beyond(rig->options().scene.tunnel->from_m);
    const int out = first_beyond(rig->options().scene.tunnel->to_m);
    EXPECT_NEAR(gain(in - 5), 1, 0.01);
    EXPECT_GT(gain(out - 15), 2);
    EXPECT_LT(gain(in + 6), 0.75 * gain(out - 15));
    EXPECT_GT(gain(out + 3), 1.35);
    EXPECT_NEAR(gain(out + 60), 1, 0.05);
    SimulationOptions options = SmallScenario("tunnel");
    options.sensor.auto_exposure = false;
    const Image usual = Rendered(*Rig(options), kLeft, out + 3);
    EXPECT_GT(MeanLuma(Rendered(*rig, kLeft, out + 3)), 1.15 * MeanLuma(usual));
}

TEST(SimulatedScriptTest, RunsFromKeyToKeyWithoutAStepInItsRate) {
    const Script script{{1, 0}, {3, 4}, {5, -1}};
    EXPECT_DOUBLE_EQ(ValueAt(script, 0), 0);
    EXPECT_DOUBLE_EQ(ValueAt(script, 2), 2);
    EXPECT_DOUBLE_EQ(ValueAt(script, 3), 4);
    EXPECT_DOUBLE_EQ(ValueAt(script, 9), -1);
    for (double t = 0.05; t < 6; t += 0.1) {
        const double slope = (ValueAt(script, t + 1e-6) - ValueAt(script, t - 1e-6)) / 2e-6;
        EXPECT_NEAR(RateAt(script, t), slope, 1e-5) << t;
    }
}

}  // namespace
}  // namespace hitchview::drivers
