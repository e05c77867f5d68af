#include <gtest/gtest.h>

#include <numeric>

#include "app/truth_calibration.hpp"
#include "calib/panorama_holes.hpp"
#include "drivers/simulated_rig.hpp"

namespace hitchview::calib {
namespace {

const algo::Projection kCanvas = algo::Projection::Cylinder(720, 120, 0.5);

RigCalibration SimulatedRig() {
    return app::CalibrationOf(drivers::SimulatedRigGeometry(1280, 720));
}

TEST(PanoramaHolesTest, ARingOfWideCamerasHasNoneAtTheHorizon) {
    const auto holes = FindHoles(SimulatedRig(), kCanvas, {});
    ASSERT_EQ(holes.size(), 8);
    for (const SeamHole& hole : holes)
        EXPECT_EQ(hole.gap_at_horizon_px, 0) << hole.right << " " << hole.left;
}

TEST(PanoramaHolesTest, AMissingCameraLeavesAHoleBetweenItsNeighbours) {
    RigCalibration rig = SimulatedRig();
    rig.cameras.erase("rear");
    rig.cameras.erase("left_rear");
    rig.cameras.erase("right_rear");
    const auto holes = FindHoles(rig, kCanvas, {});
    const auto& largest = *std::ranges::max_element(holes, {}, &SeamHole::gap_at_horizon_px);
    EXPECT_GT(largest.gap_at_horizon_px, 20);
    EXPECT_EQ(largest.right.find("left") != std::string::npos, true) << largest.right;
    EXPECT_EQ(largest.left.find("right") != std::string::npos, true) << largest.left;
}

TEST(PanoramaHolesTest, OneCameraCoversWhatItsLensCovers) {
    RigCalibration rig = SimulatedRig();
    std::erase_if(rig.cameras, [](const auto& camera) { return camera.first != "front"; });
    rig.cameras.at("front").q_unit_camera = RotationFromRpy({0, 0, 0});
    const algo::AlignmentSurface far_away{.radius_m = 1e5, .viewpoint_m = 1, .ground_m = -1e5};
    const auto holes = FindHoles(rig, kCanvas, far_away);
    ASSERT_EQ(holes.size(), 1);
    // 120 of 360 degrees are covered.
    EXPECT_NEAR(holes[0].gap_at_horizon_px, 720 * 2 / 3, 4);
}

}  // namespace
}  // namespace hitchview::calib
