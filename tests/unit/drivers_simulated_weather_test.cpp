#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "drivers/simulated_scenario.hpp"
#include "tests/support/simulated_pictures.hpp"

// Rain on the lenses, a low sun, and what the scenarios do to trailer and calibration.
namespace hitchview::drivers {
namespace {

using Image = std::vector<std::uint8_t>;

constexpr int kWidth_px = 160;
constexpr int kHeight_px = 90;
constexpr std::size_t kPixels = static_cast<std::size_t>(kWidth_px) * kHeight_px;
constexpr int kFront = 0, kLeftFront = 1, kLeft = 3, kRear = 5;
constexpr double kDegree = std::numbers::pi / 180;

SimulationOptions Small(std::string_view name) {
    SimulationOptions options = FindScenario(name)->options;
    options.width_px = kWidth_px;
    options.height_px = kHeight_px;
    options.noise_sigma = 0;
    return options;
}

/// 1 where the pictures differ by more than `by` grey levels.
std::vector<int> Differ(const Image& a, const Image& b, int by) {
    std::vector<int> differ;
    for (std::size_t i = 0; i < kPixels; ++i) differ.push_back(std::abs(a[i] - b[i]) > by ? 1 : 0);
    return differ;
}

int Count(const std::vector<int>& marks) {
    return static_cast<int>(std::count(marks.begin(), marks.end(), 1));
}

TEST(LensDropsTest, HidePartOfThePictureMostlyInTheSamePlaces) {
    SimulationOptions options = Small("rain");
    const auto rain = tests::Rig(options);
    options.scene.lens_drops = 0;
    const auto dry = tests::Rig(options);
    const auto drops = [&](int camera, int frame) {
        return Differ(tests::Rendered(*rain, camera, frame), tests::Rendered(*dry, camera, frame),
                      2);
    };
    const auto early = drops(kLeft, 30);
    const auto late = drops(kLeft, 90);
    EXPECT_GT(Count(early), 0.01 * kPixels);
    EXPECT_LT(Count(early), 0.4 * kPixels);
    int in_both = 0;
    for (std::size_t i = 0; i < kPixels; ++i) in_both += early[i] * late[i];
    EXPECT_GT(in_both, 0.5 * Count(early)) << "most stay";
    EXPECT_LT(in_both, 0.98 * Count(early)) << "some run";
    int with_other = 0;
    const auto other = drops(kLeftFront, 30);
    for (std::size_t i = 0; i < kPixels; ++i) with_other += early[i] * other[i];
    EXPECT_LT(with_other, 0.6 * Count(early)) << "each lens has its own";
}

TEST(LowSunTest, SaturatesTheLensThatLooksAtItAndNoOther) {
    SimulationOptions options = Small("low_sun");
    options.sensor.auto_exposure = false;
    options.scene.density = 0;
    options.scene.sun->azimuth_rad = 70 * kDegree;  // before left_front as the drive starts
    const auto sunny = tests::Rig(options);
    options.scene.sun.reset();
    const auto without = tests::Rig(options);
    const auto saturated = [&](const SimulatedRig& rig, int camera) {
        const Image image = tests::Rendered(rig, camera, 0);
        return std::count(image.begin(), image.begin() + kPixels, 255);
    };
    EXPECT_GT(saturated(*sunny, kLeftFront), saturated(*without, kLeftFront) + 60);
    EXPECT_LT(saturated(*sunny, kLeftFront), 0.3 * kPixels);
    EXPECT_EQ(tests::Rendered(*sunny, kRear, 0), tests::Rendered(*without, kRear, 0));
}

TEST(LowSunTest, TheVehicleTurnsThroughIt) {
    const auto rig = tests::Rig(Small("low_sun"));
    const SceneOptions::Sun& sun = *rig->options().scene.sun;
    const auto sees = [&](int camera, int frame) {
        const Eigen::Vector3d direction(std::cos(sun.azimuth_rad), std::sin(sun.azimuth_rad),
                                        std::tan(sun.elevation_rad));
        const Eigen::Vector3d eye = rig->CameraPoseAt(camera, frame).translation();
        return rig->ProjectWorldPoint(camera, frame, eye + 1000 * direction).has_value();
    };
    EXPECT_TRUE(sees(kLeft, 0));
    EXPECT_FALSE(sees(kFront, 0));
    EXPECT_TRUE(sees(kLeft, 150) && sees(kLeftFront, 150)) << "in the overlap";
    EXPECT_TRUE(sees(kFront, 299));
    EXPECT_FALSE(sees(kRear, 299));
}

TEST(SimulatedScenarioTest, ATruckComesFillsTheLeftOverlapForFourSecondsAndMoreAndGoes) {
    const auto rig = tests::Rig(Small("truck_in_overlap"));
    std::string filled;
    for (int frame = 0; frame < rig->options().frames; ++frame) {
        bool fills = true;
        for (const int camera : {kLeftFront, kLeft}) {
            const auto seen =
                rig->WorldPointAt(camera, frame, {kWidth_px / 2.0, kHeight_px / 2.0 - 10});
            fills = fills && seen && seen->distance_m < 6;
        }
        filled += fills ? 'x' : '.';
    }
    EXPECT_NE(filled.find(std::string(120, 'x')), std::string::npos) << filled;
    EXPECT_EQ(filled.front(), '.');
    EXPECT_EQ(filled.back(), '.');
}

TEST(SimulatedScenarioTest, StandingStillMovesByTheEnginesShakeAlone) {
    const auto rig = tests::Rig(Small("standing_still"));
    const auto at = [&](int frame, algo::Unit unit) { return rig->PoseAt(frame, unit); };
    for (int frame = 0; frame < rig->options().frames; frame += 7) {
        for (const algo::Unit unit : algo::kUnits) {
            const Eigen::Isometry3d moved = at(0, unit).inverse() * at(frame, unit);
            EXPECT_LT(moved.translation().norm(), 0.02);
            EXPECT_LT(Eigen::AngleAxisd(moved.linear()).angle(), 0.6 * kDegree);
        }
    }
    EXPECT_GT(
        (at(0, algo::Unit::kTractor).inverse() * at(3, algo::Unit::kTractor)).translation().norm(),
        1e-5);
}

TEST(SimulatedScenarioTest, CouplingHasTheTrailersCamerasForFourSeconds) {
    const auto rig = tests::Rig(Small("coupling"));
    for (int camera = 0; camera < SimulatedRig::kCameras; ++camera) {
        const bool trailer = rig->camera(camera).unit == algo::Unit::kTrailer;
        for (const int frame : {0, 74, 75, 194, 195, 299}) {
            const bool coupled = frame >= 75 && frame < 195;
            EXPECT_EQ(rig->CameraPresent(camera, frame), !trailer || coupled) << frame;
        }
    }
}

TEST(MiscalibratedTest, IsWhatTheOptionsSayAndThePicturesKnowNothingOfIt) {
    const SimulationOptions options = Small("wrong_calibration");
    const auto cameras = SimulatedRigGeometry(kWidth_px, kHeight_px);
    const auto wrong = Miscalibrated(cameras, options.calibration);
    const auto apart = [&](int camera) {
        const auto i = static_cast<std::size_t>(camera);
        return Eigen::Isometry3d(cameras[i].geometry.T_unit_camera.inverse() *
                                 wrong[i].geometry.T_unit_camera);
    };
    const Eigen::AngleAxisd yaw(apart(kLeft).linear());
    EXPECT_NEAR(yaw.angle(), 3 * kDegree, 1e-9);
    EXPECT_NEAR(yaw.axis().y(), -1, 1e-9) << "to the left, about what is upwards in its picture";
    const Eigen::AngleAxisd roll(apart(kFront).linear());
    EXPECT_NEAR(roll.angle(), 2 * kDegree, 1e-9);
    EXPECT_NEAR(roll.axis().z(), 1, 1e-9);
    EXPECT_TRUE(apart(kRear).linear().isIdentity(1e-12));
    const auto x = [](const SimulatedCameraGeometry& camera) {
        return camera.geometry.T_unit_camera.translation().x();
    };
    EXPECT_NEAR(x(wrong[kRear]), x(cameras[kRear]) - 0.3, 1e-12);
    EXPECT_EQ(x(wrong[kFront]), x(cameras[kFront]));
    SimulationOptions right = options;
    right.calibration = {};
    EXPECT_EQ(tests::Rendered(*tests::Rig(options), kLeft, 60),
              tests::Rendered(*tests::Rig(right), kLeft, 60));
}

}  // namespace
}  // namespace hitchview::drivers
