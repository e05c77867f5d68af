#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "drivers/simulated_camera.hpp"
#include "drivers/simulated_scenario.hpp"
#include "tests/support/simulated_pictures.hpp"

namespace hitchview::drivers {
namespace {

using algo::Unit;

constexpr double kDegree = std::numbers::pi / 180;

std::unique_ptr<SimulatedRig> TinyRig(std::string_view name) {
    SimulationOptions options = FindScenario(name)->options;
    options.width_px = 64;
    options.height_px = 36;
    return tests::Rig(options);
}

double Yaw(const SimulatedRig& rig, int frame, Unit unit) {
    const Eigen::Matrix3d R = rig.PoseAt(frame, unit, Shaking::kWithout).linear();
    return std::atan2(R(1, 0), R(0, 0));
}

TEST(SimulatedScenarioTest, EachIsAllowedAndFoundByItsOwnName) {
    std::set<std::string_view> names;
    for (const Scenario& scenario : Scenarios()) {
        EXPECT_TRUE(CheckOptions(scenario.options).ok()) << scenario.name;
        EXPECT_EQ(FindScenario(scenario.name), &scenario);
        EXPECT_FALSE(scenario.what.empty());
        names.insert(scenario.name);
    }
    EXPECT_EQ(names.size(), Scenarios().size());
    EXPECT_EQ(FindScenario("straight_"), nullptr);
    EXPECT_EQ(FindScenario(""), nullptr);
}

TEST(SimulatedScenarioTest, NoUnitTurnsFasterThanTwentyDegreesPerSecond) {
    for (const std::string_view name : {"turn_left_60", "turn_right_60", "reversing"}) {
        const auto rig = TinyRig(name);
        const double period_s = std::chrono::duration<double>(rig->options().period).count();
        for (int i = 1; i < rig->options().frames; ++i) {
            for (const Unit unit : algo::kUnits) {
                const double turned = Yaw(*rig, i, unit) - Yaw(*rig, i - 1, unit);
                const double rate = std::remainder(turned, 2 * std::numbers::pi) / period_s;
                EXPECT_LT(std::abs(rate), 20 * kDegree) << name << ' ' << i;
            }
            const double bent = rig->HitchAngleAt(i) - rig->HitchAngleAt(i - 1);
            EXPECT_LT(std::abs(bent) / period_s, 20 * kDegree) << name << ' ' << i;
        }
    }
}

TEST(SimulatedScenarioTest, ATurnReachesSixtyDegreesAtTheHitchAndComesBack) {
    for (const double side : {-1.0, 1.0}) {
        const auto rig = TinyRig(side < 0 ? "turn_left_60" : "turn_right_60");
        double largest = 0;
        for (int i = 0; i < rig->options().frames; ++i)
            largest = std::max(largest, side * rig->HitchAngleAt(i));
        EXPECT_NEAR(largest, 60 * kDegree, 1e-3);
        EXPECT_NEAR(rig->HitchAngleAt(0), 0, 1e-9);
        EXPECT_NEAR(rig->HitchAngleAt(rig->options().frames - 1), 0, 1e-6);
        // Tractors turn away from the side that the trailer comes to.
        EXPECT_GT(-side * Yaw(*rig, 210, Unit::kTractor), 0.3);
    }
}

TEST(SimulatedScenarioTest, ATrailerWithAScriptedHitchAngleDoesNotSlipSideways) {
    for (const std::string_view name : {"turn_left_60", "reversing"}) {
        SimulationOptions options = FindScenario(name)->options;
        const Motion motion(options);
        const auto pose = [&](int ms, Unit unit) {
            return motion.PoseAt(std::chrono::milliseconds(ms), unit, Shaking::kWithout);
        };
        for (int ms = 100; ms < 9900; ms += 331) {
            for (const Unit unit : algo::kUnits) {
                const Eigen::Vector3d axle{unit == Unit::kTractor
                                               ? VehicleDimensions::kTractorAxle
                                               : -VehicleDimensions::kTrailerAxle,
                                           0, 0};
                const Eigen::Vector3d moved = pose(ms + 5, unit) * axle - pose(ms - 5, unit) * axle;
                EXPECT_NEAR((pose(ms, unit).linear().transpose() * moved).y(), 0, 1e-5) << ms;
            }
        }
    }
}

TEST(SimulatedScenarioTest, ReversingGoesBackwardsAndStopAndGoHalts) {
    const auto back = TinyRig("reversing");
    const Eigen::Vector3d moved = back->PoseAt(200, Unit::kTractor).translation() -
                                  back->PoseAt(100, Unit::kTractor).translation();
    EXPECT_LT(back->PoseAt(150, Unit::kTractor).linear().col(0).dot(moved), -2);
    const auto halting = TinyRig("stop_and_go");
    const auto x = [&](int frame) {
        return halting->PoseAt(frame, Unit::kTractor, Shaking::kWithout).translation().x();
    };
    EXPECT_NEAR(x(110), x(145), 1e-9);
    EXPECT_GT(x(299), x(145) + 15);
}

TEST(SimulatedScenarioTest, ArticulationIsTheHitchAngleWithTheShakingOfBothUnits) {
    SimulationOptions options = FindScenario("turn_left_60")->options;
    options.width_px = 64;
    options.height_px = 36;
    for (ShakeOptions& shake : options.shake.of) shake.scale = 0;
    const auto still = tests::Rig(options);
    const auto shaken = TinyRig("turn_left_60");
    double largest = 0;
    for (int i = 0; i < options.frames; i += 7) {
        EXPECT_NEAR(still->ArticulationAt(i), still->HitchAngleAt(i), 1e-9);
        EXPECT_EQ(shaken->HitchAngleAt(i), still->HitchAngleAt(i));
        largest = std::max(largest, std::abs(shaken->ArticulationAt(i) - shaken->HitchAngleAt(i)));
    }
    EXPECT_GT(largest, 0.5 * kDegree);
    EXPECT_LT(largest, 4 * kDegree);
}

TEST(SimulatedScenarioTest, ALostCameraDeliversNothingForTwoSecondsAndComesBack) {
    const auto rig = TinyRig("camera_lost");
    ASSERT_EQ(rig->options().sensor.outages.size(), 2U);
    const SensorOptions::Outage& outage = rig->options().sensor.outages[0];
    EXPECT_EQ(outage.end_frame - outage.first_frame, 60);
    SimulatedCamera sut(*rig, outage.camera, hal::Instant{0});
    for (int i = 0; i < rig->options().frames; ++i) {
        const bool present = i < outage.first_frame || i >= outage.end_frame;
        EXPECT_EQ(rig->CameraPresent(outage.camera, i), present) << i;
        const auto frame_result = sut.WaitFrame(std::chrono::milliseconds(100));
        ASSERT_EQ(frame_result.ok(), present) << i;
        if (present) {
            EXPECT_EQ(frame_result.value().view().header.sequence, static_cast<std::uint32_t>(i));
        } else {
            EXPECT_EQ(frame_result.error(), hal::Error::kCorrupted);
        }
    }
}

TEST(SimulatedScenarioTest, GainsJumpByUpToThirtyPercentAtTheirOwnTimes) {
    const auto rig = TinyRig("exposure_steps");
    std::set<int> jumping;
    for (int frame = 1; frame < rig->options().frames; ++frame) {
        int jumps = 0;
        for (int camera = 0; camera < SimulatedRig::kCameras; ++camera) {
            const double factor = rig->GainAt(camera, frame) / rig->GainOf(camera);
            EXPECT_GE(factor, 0.7 - 1e-9);
            EXPECT_LE(factor, 1.3 + 1e-9);
            if (rig->GainAt(camera, frame) == rig->GainAt(camera, frame - 1)) continue;
            ++jumps;
            jumping.insert(camera);
        }
        EXPECT_LE(jumps, 1) << frame;
    }
    EXPECT_GE(jumping.size(), 4U);
}

}  // namespace
}  // namespace hitchview::drivers
