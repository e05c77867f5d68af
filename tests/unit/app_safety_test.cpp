#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/safety_meter.hpp"
#include "app/simulated_geometry.hpp"
#include "app/truth_jump.hpp"
#include "drivers/simulated_scenario.hpp"
#include "tests/support/simulated_pictures.hpp"

namespace hitchview::app {
namespace {

using algo::Overlap;
using algo::Unit;

/// The simulated vehicle, straight and standing still, on a canvas of 1024 px.
class SafetyTest : public testing::Test {
 protected:
    static drivers::SimulationOptions Options() {
        drivers::SimulationOptions options = drivers::FindScenario("straight")->options;
        options.frames = 4;
        options.width_px = 320;
        options.height_px = 180;
        options.speed_mps = 0;
        for (drivers::ShakeOptions& shake : options.shake.of) shake.scale = 0;
        return options;
    }
    static algo::Composition Straight() {
        algo::Composition composition;
        composition.seams = {{algo::SeamState::kLocked, algo::SeamState::kLocked}};
        return composition;
    }
    /// The trailer's view that far to the right.
    [[nodiscard]] algo::Composition Turned(double px) const {
        algo::Composition composition = Straight();
        composition.M_canvas_view[Unit::kTrailer] = algo::ToPose(geometry_.canvas, {{px, 0, 0}});
        return composition;
    }
    const algo::ComposedMap& MapOf(const algo::Composition& composition) {
        map_.Build(composition, runner_);
        return map_;
    }

    std::unique_ptr<drivers::SimulatedRig> rig_ = tests::Rig(Options());
    RigGeometry geometry_ = GeometryOf(*rig_, 1024).value();
    algo::SerialRunner runner_;
    algo::ComposedMap map_{geometry_.canvas, geometry_.units, algo::SeamOptions{}};
};

TEST_F(SafetyTest, NoCellOfTheCalibratedMapIsFolded) {
    EXPECT_EQ(FoldedDrawnCells(MapOf(Straight()), geometry_), 0);
    EXPECT_EQ(FoldedDrawnCells(MapOf(Turned(40)), geometry_), 0);
}

TEST_F(SafetyTest, AFieldThatTurnsBackFoldsCellsOfBothUnits) {
    algo::Composition composition = Straight();
    // At one vertex on the front the tractor is read 60 px to the side, the cells are 32 px wide.
    composition.discrepancy(0, algo::Mesh::Index(5, algo::Mesh::kCols / 2)) = 120;
    EXPECT_GT(FoldedDrawnCells(MapOf(composition), geometry_), 4);
}

TEST_F(SafetyTest, AViewThatMovesWhileTheVehicleStandsIsAJump) {
    TruthJump sut(*rig_, geometry_);
    sut.Observe(0, Straight(), MapOf(Straight()));
    sut.Observe(1, Straight(), MapOf(Straight()));
    EXPECT_LT(sut.figures(Overlap::kLeft).largest_seam_px, 0.3);
    EXPECT_LT(sut.figures(Overlap::kLeft).largest_placement_px, 1e-6);
    sut.Observe(2, Turned(12), MapOf(Turned(12)));
    for (const Overlap overlap : algo::kOverlaps) {
        EXPECT_NEAR(sut.figures(overlap).largest_seam_px, 12, 0.5);
        EXPECT_NEAR(sut.figures(overlap).largest_placement_px, 12, 1e-6);
        EXPECT_EQ(sut.figures(overlap).frames, 2);
    }
}

TEST_F(SafetyTest, AFieldThatMovesTheSeamIsAJumpToo) {
    TruthJump sut(*rig_, geometry_);
    sut.Observe(0, Straight(), MapOf(Straight()));
    algo::Composition late = Straight();
    late.discrepancy.row(0).setConstant(-9);
    sut.Observe(1, late, MapOf(late));
    EXPECT_NEAR(sut.figures(Overlap::kRight).largest_seam_px, 9, 0.5);
    EXPECT_LT(sut.figures(Overlap::kRight).largest_placement_px, 1e-6);
}

TEST_F(SafetyTest, OnlyFramesInARowThatAreLockedAreCompared) {
    TruthJump sut(*rig_, geometry_);
    algo::Composition lost = Straight();
    lost.seams[Overlap::kLeft] = algo::SeamState::kCoast;
    sut.Observe(0, lost, MapOf(lost));
    sut.Observe(1, Turned(30), MapOf(Turned(30)));
    EXPECT_EQ(sut.figures(Overlap::kLeft).frames, 0);
    EXPECT_EQ(sut.figures(Overlap::kLeft).largest_placement_px, 0);
    EXPECT_NEAR(sut.figures(Overlap::kRight).largest_placement_px, 30, 1e-6);
    sut.Observe(3, Straight(), MapOf(Straight()));
    EXPECT_EQ(sut.figures(Overlap::kRight).frames, 1);
}

}  // namespace
}  // namespace hitchview::app
