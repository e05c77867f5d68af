#include <gtest/gtest.h>

#include <cmath>

#include "drivers/simulated_motion.hpp"
#include "drivers/simulated_road.hpp"

namespace hitchview::drivers {
namespace {

class SimulatedRoadTest : public testing::TestWithParam<DriveProfile> {
 protected:
    SimulatedRoadTest() { options_.profile = GetParam(); }
    SimulationOptions options_;
};

TEST_P(SimulatedRoadTest, TheTractorStaysOnTheDrivenLane) {
    const Road road(options_);
    const Motion motion(options_);
    for (int ms = 0; ms < 9000; ms += 173) {
        const Eigen::Isometry3d tractor =
            motion.PoseAt(std::chrono::milliseconds(ms), algo::Unit::kTractor, Shaking::kWithout);
        const Eigen::Vector3d axle =
            tractor * Eigen::Vector3d{VehicleDimensions::kTractorAxle, 0, 0};
        const RoadPoint point = road.FromWorld(axle.head<2>());
        EXPECT_NEAR(point.across_m, 0, 0.01) << ms;
        EXPECT_NEAR(point.cos_heading, tractor.linear()(0, 0), 0.01) << ms;
        EXPECT_NEAR(point.sin_heading, tractor.linear()(1, 0), 0.01) << ms;
    }
}

TEST_P(SimulatedRoadTest, ToWorldInvertsFromWorldOnTheLane) {
    const Road road(options_);
    for (double along_m = -30; along_m < 30; along_m += 1.7) {
        const RoadPoint point = road.FromWorld(road.ToWorld(along_m, 0));
        EXPECT_NEAR(point.along_m, along_m, 0.01);
        EXPECT_NEAR(point.across_m, 0, 0.01);
    }
}

INSTANTIATE_TEST_SUITE_P(Profiles, SimulatedRoadTest,
                         testing::Values(DriveProfile::kStraight, DriveProfile::kSlalom,
                                         DriveProfile::kTurnLeft, DriveProfile::kTurnRight));

TEST(SimulatedRoadStandingTest, AVehicleThatStandsHasAStraightRoad) {
    SimulationOptions options;
    options.speed_mps = 0;
    EXPECT_DOUBLE_EQ(Road(options).FromWorld({12, 3}).across_m, 3);
}

}  // namespace
}  // namespace hitchview::drivers
