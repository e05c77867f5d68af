#include <gtest/gtest.h>

#include "algo/feature_mask.hpp"
#include "algo/guidance.hpp"
#include "tests/support/hinged_rig.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

constexpr double kScale = 0.5;

/// The four side cameras of a rig, both units posed on a canvas of the views' size.
class RingGuidanceTest : public testing::Test {
 protected:
    [[nodiscard]] PerUnit<Guidance::Side> Sides() const {
        return {{Guidance::Side{&tractor_, rig_[Unit::kTractor].view(), pose_[Unit::kTractor]},
                 Guidance::Side{&trailer_, rig_[Unit::kTrailer].view(), pose_[Unit::kTrailer]}}};
    }
    /// Visits analysis pixels of the unit's view.
    template <typename Visitor>
    static void ForEachPixel(const Visitor& visit) {
        for (float y = 12; y < 168; y += 13) {
            for (float x = 3; x < 1021; x += 17) visit(Vector2f(x, y));
        }
    }
    [[nodiscard]] const SemiSurroundView& ViewOf(Unit unit) const {
        return unit == Unit::kTractor ? tractor_ : trailer_;
    }
    /// Where a pixel of the unit lies on the canvas.
    [[nodiscard]] Vector2d OnCanvas(Unit unit, const Vector2f& pixel) const {
        return canvas_.Pixel(pose_[unit] * rig_[unit].view().Ray(ViewOf(unit).ToView(pixel)));
    }

    const PerUnit<UnitGeometry> rig_ = tests::HingedRig();
    const SemiSurroundView tractor_{rig_[Unit::kTractor], kScale};
    const SemiSurroundView trailer_{rig_[Unit::kTrailer], kScale};
    const Projection canvas_ = Projection::Cylinder(2048, 360, 0.5);
    PerUnit<Eigen::Matrix3d> pose_{
        {ToPose(canvas_, {{11, 0.01, -0.02}}), ToPose(canvas_, {{-40, -0.02, 0.01}})}};
    VertexField discrepancy_ = VertexField::Zero();
};

TEST_F(RingGuidanceTest, ExpectsAPixelWhereTheOtherViewLiesOnTheSamePlaceOfTheCanvas) {
    discrepancy_.row(0).setConstant(9);
    discrepancy_.row(1).setConstant(-4);
    const PerUnit<Guidance::Side> sides = Sides();
    int expected = 0;
    for (const Overlap overlap : kOverlaps) {
        int candidates = 0;
        const Guidance sut(canvas_, sides, discrepancy_, overlap, candidates);
        for (const Unit unit : kUnits) {
            ForEachPixel([&](const Vector2f& pixel) {
                Vector2f other;
                if (!sut.Expect(unit, pixel, other)) return;
                ++expected;
                const Vector2d apart =
                    canvas_.Difference(OnCanvas(Other(unit), other), OnCanvas(unit, pixel));
                const Vector2d e = unit == Unit::kTractor ? Vector2d(9, -4) : Vector2d(-9, 4);
                EXPECT_LT((apart - e).norm(), 0.01) << pixel.transpose();
            });
        }
    }
    EXPECT_GT(expected, 100);
}

TEST_F(RingGuidanceTest, CountsWhatTheOtherViewShowsInThisOverlapAndNothingElse) {
    const PerUnit<Guidance::Side> sides = Sides();
    PerOverlap<int> candidates;
    PerOverlap<int> shown;
    for (const Overlap overlap : kOverlaps) {
        const Guidance sut(canvas_, sides, discrepancy_, overlap, candidates[overlap]);
        ForEachPixel([&](const Vector2f& pixel) {
            const Vector2d at = OnCanvas(Unit::kTractor, pixel);
            const bool here = (at.x() < canvas_.Centre().x()) == (overlap == Overlap::kLeft);
            const Vector2d view_px = rig_[Unit::kTrailer].view().Pixel(
                pose_[Unit::kTrailer].inverse() * canvas_.Ray(at));
            Vector2f other;
            const bool found = sut.Expect(Unit::kTractor, pixel, other);
            const bool seen = Allows(trailer_.mask(), trailer_.ToAnalysis(view_px));
            EXPECT_EQ(found, here && seen) << pixel.transpose();
            shown[overlap] += here && seen ? 1 : 0;
        });
        EXPECT_EQ(candidates[overlap], shown[overlap]);
        EXPECT_GT(shown[overlap], 20);
    }
}

TEST(PlaneGuidanceTest, APlaneHasTheRightOverlapAlone) {
    const UnitGeometry geometry = UnitGeometry::Plane(200, 120);
    const SemiSurroundView view(geometry, 1);
    const Projection canvas = Projection::Plane(320, 120);
    Eigen::Matrix3d beside = Eigen::Matrix3d::Identity();
    beside(0, 2) = 100;
    const PerUnit<Guidance::Side> sides{
        {Guidance::Side{&view, geometry.view(), Eigen::Matrix3d::Identity()},
         Guidance::Side{&view, geometry.view(), beside}}};
    const VertexField nothing = VertexField::Zero();
    int candidates = 0;
    const Guidance right(canvas, sides, nothing, Overlap::kRight, candidates);
    const Guidance left(canvas, sides, nothing, Overlap::kLeft, candidates);
    Vector2f other;
    ASSERT_TRUE(right.Expect(Unit::kTractor, {150, 60}, other));
    EXPECT_LT((other - Vector2f(50, 60)).norm(), 1e-3F);
    EXPECT_FALSE(right.Expect(Unit::kTractor, {50, 60}, other)) << "left of the trailer's view";
    EXPECT_FALSE(left.Expect(Unit::kTractor, {150, 60}, other));
    EXPECT_EQ(candidates, 1);
}

}  // namespace
}  // namespace hitchview::algo
