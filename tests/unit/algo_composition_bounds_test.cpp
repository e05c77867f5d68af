#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algo/composition_bounds.hpp"

namespace hitchview::algo {
namespace {

const Projection kRing = Projection::Cylinder(2048, 360, 0.5);
constexpr double kDegree = 3.14159265358979 / 180;

class CompositionBoundsTest : public testing::Test {
 protected:
    OffsetShares Shares() const { return SharesOf(composition_, bounds_, kRing); }

    CompositionBounds bounds_ = BoundsOf(kRing, kRing);
    Composition composition_;
};

// The figures that docs/algorithm.md states for a ring of 2048 px.
TEST_F(CompositionBoundsTest, AreThoseThatTheDocumentStates) {
    const double px_per_rad = kRing.focal_px;
    EXPECT_NEAR(bounds_.stabilization.x(), 10 * kDegree * px_per_rad, 1e-6);
    EXPECT_NEAR(bounds_.stabilization.y(), 6 * kDegree, 1e-9);
    EXPECT_NEAR(bounds_.placement.x(), 110 * kDegree * px_per_rad + 8, 1e-6);
    EXPECT_NEAR(bounds_.placement.z(), 20 * kDegree + 0.02, 1e-9);
    EXPECT_EQ(bounds_.view_offset_px, 2);
    EXPECT_NEAR(bounds_.discrepancy_px, 19.6, 0.05);
    EXPECT_NEAR(bounds_.detail_px, 176, 0.1);
}

TEST_F(CompositionBoundsTest, NothingMovedIsNoShare) {
    EXPECT_EQ(Shares().Largest(), 0);
}

TEST_F(CompositionBoundsTest, EachOffsetCountsAgainstItsOwnBound) {
    composition_.stabilization[Unit::kTrailer].value.y() = -3 * kDegree;
    EXPECT_NEAR(Shares().stabilization, 0.5, 1e-9);
    composition_.view_offset[Unit::kTractor](1, 40) = -1.5F;
    EXPECT_NEAR(Shares().view_offset, 0.75, 1e-6);
    composition_.discrepancy(0, 7) = static_cast<float>(2 * bounds_.discrepancy_px);
    EXPECT_NEAR(Shares().discrepancy, 2, 1e-5);
    composition_.detail = CornerField(kRing, Eigen::Vector2f::Zero());
    composition_.detail.at(3, 5).x() = static_cast<float>(-0.25 * bounds_.detail_px);
    EXPECT_NEAR(Shares().detail, 0.25, 1e-6);
    composition_.M_canvas_view[Unit::kTrailer] =
        ToPose(kRing, {{0.8 * bounds_.placement.x(), 0, 0}});
    EXPECT_NEAR(Shares().placement, 0.8, 1e-6);
    EXPECT_NEAR(Shares().Largest(), 2, 1e-5);
}

TEST_F(CompositionBoundsTest, OfTwoSharesTheLargerIsKeptForEachOffset) {
    OffsetShares most{.stabilization = 1, .placement = 2, .view_offset = 3};
    most.TakeLarger({.stabilization = 4, .placement = 1, .discrepancy = 5, .detail = 6});
    EXPECT_EQ(most.stabilization, 4);
    EXPECT_EQ(most.placement, 2);
    EXPECT_EQ(most.view_offset, 3);
    EXPECT_EQ(most.discrepancy, 5);
    EXPECT_EQ(most.detail, 6);
}

TEST_F(CompositionBoundsTest, WhatIsNotFiniteExceedsEveryBound) {
    composition_.discrepancy(1, 3) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isinf(Shares().discrepancy));
    composition_.M_canvas_view[Unit::kTractor](0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isinf(Shares().placement));
}

}  // namespace
}  // namespace hitchview::algo
