#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/overlay_maker.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/small_ring.hpp"

namespace hitchview::app {
namespace {

using algo::Mesh;
using algo::Unit;
using Eigen::Vector2d;
using std::chrono::milliseconds;

/// A ring whose views lie on the canvas as they are.
class OverlayMakerTest : public testing::Test {
 protected:
    OverlayMakerTest() {
        rig_.canvas = algo::Projection::Cylinder(768, 128, 0.5);
        rig_.units[Unit::kTractor] =
            algo::UnitGeometry::Ring(rig_.canvas, tests::LevelCameras(3, 1.2, 0), {});
        rig_.units[Unit::kTrailer] = algo::UnitGeometry::Ring(
            rig_.canvas, tests::LevelCameras(3, 1.2, std::numbers::pi), {});
        map_ = std::make_unique<algo::ComposedMap>(rig_.canvas, rig_.units, algo::SeamOptions{});
        map_->Build(composition_, runner_);
        overlay_ = std::make_unique<OverlayMaker>(rig_, map_->block_px(), milliseconds(200));
    }

    RigGeometry rig_;
    algo::Composition composition_;
    algo::SerialRunner runner_;
    std::unique_ptr<algo::ComposedMap> map_;
    std::unique_ptr<OverlayMaker> overlay_;
};

TEST_F(OverlayMakerTest, VerticesOfViewsThatLieAsTheyAreAreWhereTheProjectionSays) {
    overlay_->Offer({9, milliseconds(5)}, composition_, *map_, milliseconds(1));
    const auto overlay = overlay_->Take();
    ASSERT_TRUE(overlay);
    EXPECT_EQ(overlay->sequence, 9U);
    EXPECT_EQ(overlay->captured_from, milliseconds(5));
    EXPECT_EQ(overlay->width_px, 768);
    EXPECT_EQ(overlay->height_px, 128);
    ASSERT_EQ(overlay->mesh_rows, Mesh::kVertexRows);
    ASSERT_EQ(overlay->mesh_cols, Mesh::kVertexCols);
    ASSERT_EQ(overlay->mesh_x.size(), std::size_t{2} * Mesh::kVertices);
    const Mesh mesh(rig_.canvas);
    int seen = 0;
    for (int i = 0; i < 2 * Mesh::kVertices; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (std::isnan(overlay->mesh_x[at])) continue;
        ++seen;
        const int vertex = i % Mesh::kVertices;
        const Vector2d expected =
            mesh.Vertex(vertex / Mesh::kVertexCols, vertex % Mesh::kVertexCols);
        const Vector2d shown(overlay->mesh_x[at], overlay->mesh_y[at]);
        EXPECT_LT(rig_.canvas.Difference(shown, expected).norm(), 0.01) << i;
    }
    EXPECT_GT(seen, Mesh::kVertices);           // both units see more than half the ring
    EXPECT_LT(seen, 2 * Mesh::kVertices - 20);  // and neither sees all
}

TEST_F(OverlayMakerTest, ATurnOfAViewMovesItsVerticesAlong) {
    const double turn_rad = 0.1;
    composition_.M_canvas_view[Unit::kTractor] =
        Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    overlay_->Offer({1, {}}, composition_, *map_, milliseconds(1));
    const auto overlay = overlay_->Take();
    ASSERT_TRUE(overlay);
    const Mesh mesh(rig_.canvas);
    const int ahead = Mesh::Index(5, 16);
    const double moved_px =
        rig_.canvas.Difference({overlay->mesh_x[ahead], overlay->mesh_y[ahead]}, mesh.Vertex(5, 16))
            .x();
    EXPECT_NEAR(moved_px, -rig_.canvas.focal_px * turn_rad, 0.01);  // x falls with the azimuth
}

TEST_F(OverlayMakerTest, SeamsAreToldRowByRow) {
    overlay_->Offer({1, {}}, composition_, *map_, milliseconds(1));
    const auto overlay = overlay_->Take();
    ASSERT_TRUE(overlay);
    ASSERT_EQ(overlay->seam_y.size(), static_cast<std::size_t>(map_->block_rows() + 1));
    for (std::size_t row = 0; row < overlay->seam_y.size(); ++row) {
        const int corner_row = static_cast<int>(row);
        EXPECT_FLOAT_EQ(overlay->seam_y[row],
                        static_cast<float>(corner_row * map_->block_px()) - 0.5F);
        EXPECT_FLOAT_EQ(overlay->left_seam_x[row],
                        static_cast<float>(map_->seam_px(algo::Overlap::kLeft, corner_row)));
        EXPECT_FLOAT_EQ(overlay->right_seam_x[row],
                        static_cast<float>(map_->seam_px(algo::Overlap::kRight, corner_row)));
    }
}

TEST_F(OverlayMakerTest, AtMostOneInAPeriodAndEachIsTakenOnce) {
    int taken = 0;
    for (int i = 0; i < 90; ++i) {  // three seconds
        overlay_->Offer({static_cast<std::uint32_t>(i), {}}, composition_, *map_,
                        i * milliseconds(33));
        if (overlay_->Take()) ++taken;
        EXPECT_FALSE(overlay_->Take());
    }
    EXPECT_GE(taken, 12);
    EXPECT_LE(taken, 15);
}

TEST_F(OverlayMakerTest, WhatNobodyTookIsNotWrittenOver) {
    overlay_->Offer({1, {}}, composition_, *map_, milliseconds(0));
    overlay_->Offer({2, {}}, composition_, *map_, milliseconds(900));
    EXPECT_EQ(overlay_->Take()->sequence, 1U);
}

TEST_F(OverlayMakerTest, NothingTakesMemoryAfterConstruction) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    composition_.detail = algo::CornerField(rig_.canvas, {1, 1});
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    for (int i = 0; i < 5; ++i) {
        overlay_->Offer({1, {}}, composition_, *map_, i * milliseconds(200));
        if (i == 2) composition_.detail.Clear();
        [[maybe_unused]] const auto overlay = overlay_->Take();
    }
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

}  // namespace
}  // namespace hitchview::app
