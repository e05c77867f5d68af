#include <gtest/gtest.h>

#include <numbers>

#include "algo/composed_map.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "tests/support/small_ring.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

using Rig = PerUnit<std::optional<UnitGeometry>>;

Rig TwoPlanes(int width_px, int height_px) {
    Rig rig;
    for (const Unit unit : kUnits) rig[unit] = UnitGeometry::Plane(width_px, height_px);
    return rig;
}

Composition SideBySide(double trailer_x) {
    Composition composition;
    composition.M_canvas_view[Unit::kTrailer](0, 2) = trailer_x;
    return composition;
}

Vector2d CornerPixel(int row, int col) {
    return {8.0 * col - 0.5, 8.0 * row - 0.5};
}

TEST(ComposedMapTest, ACornerIsWhereTheInverseOfThePosePutsIt) {
    const Rig rig = TwoPlanes(200, 120);
    ComposedMap map(Projection::Plane(200, 120), rig, {});
    Composition composition;
    Matrix3d m;
    m << 0.98, -0.2, 12, 0.2, 0.98, -7, 0, 0, 1;
    composition.M_canvas_view[Unit::kTractor] = m;
    SerialRunner runner;
    map.Build(composition, runner);
    for (int row = 0; row <= map.block_rows(); row += 3) {
        for (int col = 0; col <= map.block_cols(); col += 3) {
            const Vector2d expected =
                (m.inverse() * CornerPixel(row, col).homogeneous()).hnormalized();
            EXPECT_NEAR(map.corner(0, row, col).x, expected.x(), 1e-4);
            EXPECT_NEAR(map.corner(0, row, col).y, expected.y(), 1e-4);
            EXPECT_TRUE(map.corner(0, row, col).sees);
        }
    }
}

TEST(ComposedMapTest, KappaSplitsTheDiscrepancyBetweenTheUnits) {
    const Rig rig = TwoPlanes(200, 120);
    ComposedMap map(Projection::Plane(200, 120), rig, {});
    Composition composition;
    composition.discrepancy.row(0).setConstant(6);
    composition.discrepancy.row(1).setConstant(-2);
    composition.kappa = 0.25;
    SerialRunner runner;
    map.Build(composition, runner);
    const Vector2d at = CornerPixel(7, 9);
    EXPECT_NEAR(map.corner(0, 7, 9).x, at.x() - 0.25 * 6, 1e-4);
    EXPECT_NEAR(map.corner(0, 7, 9).y, at.y() + 0.25 * 2, 1e-4);
    EXPECT_NEAR(map.corner(1, 7, 9).x, at.x() + 0.75 * 6, 1e-4);
    EXPECT_NEAR(map.corner(1, 7, 9).y, at.y() - 0.75 * 2, 1e-4);
}

TEST(ComposedMapTest, AViewOffsetMovesTheContentByThatOffset) {
    const Rig rig = TwoPlanes(200, 120);
    ComposedMap map(Projection::Plane(200, 120), rig, {});
    Composition composition;
    composition.view_offset[Unit::kTractor].row(0).setConstant(3);
    SerialRunner runner;
    map.Build(composition, runner);
    EXPECT_NEAR(map.corner(0, 5, 5).x, CornerPixel(5, 5).x() - 3, 1e-4);
}

TEST(ComposedMapTest, TheSeamLiesInTheMiddleOfTheOverlapAndFollowsItSlowly) {
    const Rig rig = TwoPlanes(200, 120);
    ComposedMap map(Projection::Plane(320, 120), rig, {.tracking_gain = 0.1});
    SerialRunner runner;
    map.Build(SideBySide(120), runner);
    EXPECT_NEAR(map.seam_px()[Overlap::kRight], 160, 8) << "overlap 120..199";
    const double before = map.seam_px()[Overlap::kRight];
    map.Build(SideBySide(80), runner);
    const double after = map.seam_px()[Overlap::kRight];
    EXPECT_NEAR(after - before, 0.1 * (140 - before), 1.0);
    for (int i = 0; i < 100; ++i) map.Build(SideBySide(80), runner);
    EXPECT_NEAR(map.seam_px()[Overlap::kRight], 140, 8);
}

TEST(ComposedMapTest, SharesOfTheUnitsCrossOverAtTheSeamAndAddUpToOne) {
    const Rig rig = TwoPlanes(200, 120);
    SerialRunner runner;
    for (const double trailer_x : {110.0, -110.0}) {
        ComposedMap map(Projection::Plane(320, 120), rig, {});
        Composition composition = SideBySide(trailer_x);
        composition.M_canvas_view[Unit::kTractor](0, 2) = trailer_x < 0 ? 110 : 0;
        composition.M_canvas_view[Unit::kTrailer](0, 2) = std::max(0.0, trailer_x);
        map.Build(composition, runner);
        const double seam = map.seam_px()[Overlap::kRight];
        for (int col = 0; col <= map.block_cols(); ++col) {
            const double beyond = (CornerPixel(7, col).x() - seam) * (trailer_x > 0 ? 1 : -1);
            const float tractor = map.corner(0, 7, col).weight;
            const float trailer = map.corner(1, 7, col).weight;
            EXPECT_NEAR(tractor + trailer, 1, 2e-3F);
            EXPECT_TRUE(beyond > -12 || tractor > 0.99F) << col;
            EXPECT_TRUE(beyond < 12 || trailer > 0.99F) << col;
        }
    }
}

TEST(ComposedMapTest, OneUnitCanBeSelectedAloneAndBothAgain) {
    const Rig rig = TwoPlanes(200, 120);
    ComposedMap map(Projection::Plane(320, 120), rig, {});
    SerialRunner runner;
    map.Build(SideBySide(120), runner);
    const auto weights = [&] {
        std::vector<float> all;
        for (int col = 0; col <= map.block_cols(); ++col) {
            all.push_back(map.corner(0, 4, col).weight);
            all.push_back(map.corner(1, 4, col).weight);
        }
        return all;
    };
    const std::vector<float> both = weights();
    map.SelectUnit(Unit::kTrailer);
    for (int col = 0; col <= map.block_cols(); ++col) {
        EXPECT_EQ(map.corner(0, 4, col).weight, 0);
        EXPECT_EQ(map.corner(1, 4, col).weight, 1);
    }
    map.SelectBoth();
    EXPECT_EQ(weights(), both);
}

TEST(ComposedMapTest, OnARingTheTractorLiesBetweenTheTwoSeams) {
    const Projection canvas = Projection::Cylinder(768, 128, 0.5);
    Rig rig;
    rig[Unit::kTractor] = UnitGeometry::Ring(canvas, tests::LevelCameras(3, 1.2, 0), {});
    rig[Unit::kTrailer] =
        UnitGeometry::Ring(canvas, tests::LevelCameras(3, 1.2, std::numbers::pi), {});
    ComposedMap map(canvas, rig, {});
    SerialRunner runner;
    map.Build({}, runner);
    // Mirror-symmetric: the seams lie at plus and minus 90 degrees.
    EXPECT_NEAR(map.seam_px()[Overlap::kLeft], 768 * 0.25, 10);
    EXPECT_NEAR(map.seam_px()[Overlap::kRight], 768 * 0.75, 10);
    ASSERT_EQ(map.cameras(), 6);
    const auto share = [&](Unit unit, int col) {
        float sum = 0;
        for (int s = 0; s < map.cameras(); ++s) {
            if (map.unit_of(s) == unit) sum += map.corner(s, 8, col).weight;
        }
        return sum;
    };
    for (int col = 0; col <= map.block_cols(); ++col) {
        EXPECT_NEAR(share(Unit::kTractor, col) + share(Unit::kTrailer, col), 1, 2e-3F) << col;
    }
    EXPECT_GT(share(Unit::kTractor, 48), 0.99F);
    EXPECT_GT(share(Unit::kTrailer, 4), 0.99F);
    EXPECT_GT(share(Unit::kTrailer, 92), 0.99F);
}

}  // namespace
}  // namespace hitchview::algo
