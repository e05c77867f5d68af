#include <gtest/gtest.h>

#include <numbers>

#include "algo/composed_map.hpp"
#include "algo/unified_vertex_motion.hpp"
#include "tests/support/nv12_picture.hpp"
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

/// Two plane units that overlap in 100..199 of the canvas, and what they see.
class PicturedPlanesTest : public testing::Test {
 protected:
    PicturedPlanesTest() {
        for (const Unit unit : kUnits) gains_[unit].fill(1);
    }
    void Show(const cv::Mat1b& tractor, const cv::Mat1b& trailer, int times = 1) {
        const tests::Nv12Picture tractor_picture(tractor);
        const tests::Nv12Picture trailer_picture(trailer);
        RigFrames frames;
        frames[Unit::kTractor][0] = tractor_picture.frame();
        frames[Unit::kTrailer][0] = trailer_picture.frame();
        SerialRunner runner;
        for (int i = 0; i < times; ++i) map_.Build(SideBySide(100), {frames, gains_}, runner);
    }
    static cv::Mat1b Plain() { return cv::Mat1b(120, 200, std::uint8_t{100}); }
    /// The tractor's picture with something at canvas columns from..to that the trailer's lacks.
    static cv::Mat1b With(int from, int to) {
        cv::Mat1b picture = Plain();
        picture.colRange(from, to).rowRange(30, 120).setTo(200);
        return picture;
    }
    [[nodiscard]] double SeamAt(int row) const { return map_.seam_px(Overlap::kRight, row); }

    Rig rig_ = TwoPlanes(200, 120);
    ComposedMap map_{Projection::Plane(320, 120), rig_, {}};
    CameraGains gains_;
};

TEST_F(PicturedPlanesTest, TheSeamGoesRoundWhatTheUnitsShowDifferently) {
    Show(With(140, 165), Plain());
    for (int row = 5; row <= map_.block_rows(); ++row) {
        EXPECT_TRUE(SeamAt(row) < 140 || SeamAt(row) > 165) << row << ": " << SeamAt(row);
        EXPECT_GT(SeamAt(row), 100);
        EXPECT_LT(SeamAt(row), 200);
    }
    for (int row = 1; row <= map_.block_rows(); ++row)
        EXPECT_LE(std::abs(SeamAt(row) - SeamAt(row - 1)), map_.block_px() + 1e-9);
}

TEST_F(PicturedPlanesTest, WhatComesIntoTheSeamsWayMovesItWithoutAJump) {
    Show(Plain(), Plain());
    EXPECT_NEAR(SeamAt(8), 150, 8);
    const float glide_px = SeamPathOptions{}.glide_px;
    for (int frame = 0; frame < 40; ++frame) {
        const double before = SeamAt(8);
        Show(With(140, 165), Plain());
        ASSERT_LE(std::abs(SeamAt(8) - before), glide_px + 1e-6) << frame;
    }
    EXPECT_TRUE(SeamAt(8) < 140 || SeamAt(8) > 165) << SeamAt(8);
}

TEST_F(PicturedPlanesTest, EqualPicturesWithDifferentGainsLeaveTheSeamWhereItIs) {
    gains_[Unit::kTractor][0] = 2;
    const cv::Mat1b dark(120, 200, std::uint8_t{50});
    Show(dark, Plain(), 20);
    EXPECT_NEAR(SeamAt(8), 150, 8);
}

TEST_F(PicturedPlanesTest, TheTractorsShareCrossesOverAtTheCurve) {
    Show(With(140, 165), Plain());
    for (int row = 0; row <= map_.block_rows(); ++row) {
        for (int col = 0; col <= map_.block_cols(); ++col) {
            const double beyond = CornerPixel(row, col).x() - SeamAt(row);
            EXPECT_TRUE(beyond > -9 || map_.corner(0, row, col).weight > 0.99F);
            EXPECT_TRUE(beyond < 9 || map_.corner(1, row, col).weight > 0.99F);
        }
    }
}

TEST(ComposedMapTest, TheNeighbourTakesOverWhatAMissingCameraOfItsUnitWouldShow) {
    const Projection canvas = Projection::Cylinder(768, 128, 0.5);
    Rig rig;
    rig[Unit::kTractor] = UnitGeometry::Ring(canvas, tests::LevelCameras(3, 1.3, 0), {});
    ComposedMap map(canvas, rig, {});
    const tests::Nv12Picture picture(cv::Mat1b(200, 320, std::uint8_t{90}));
    RigFrames frames;
    for (const std::size_t i : {0U, 2U}) frames[Unit::kTractor][i] = picture.frame();
    CameraGains gains;
    gains[Unit::kTractor].fill(1);
    SerialRunner runner;
    map.Build({}, {frames, gains}, runner);
    int taken_over = 0;
    int lost = 0;
    for (int col = 0; col <= map.block_cols(); ++col) {
        const float neighbours = map.corner(0, 8, col).weight + map.corner(2, 8, col).weight;
        const float missing = map.corner(1, 8, col).weight;
        EXPECT_LT(missing, 1e-5F) << "it outweighs nothing";
        if (missing > 0 && neighbours > 0) ++taken_over;
        if (missing > 0 && neighbours == 0) ++lost;
        EXPECT_TRUE(neighbours == 0 || std::abs(neighbours - 1) < 1e-5F) << col;
    }
    EXPECT_GT(taken_over, 5);
    EXPECT_GT(lost, 2) << "what nobody else sees still knows its camera, for the hatch";
}

}  // namespace
}  // namespace hitchview::algo
