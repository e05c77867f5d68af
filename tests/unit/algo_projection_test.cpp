#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/core.hpp>

#include "algo/projection.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

const Projection kPlane = Projection::Plane(640, 360);
const Projection kRing = Projection::Cylinder(2048, 320, 0.4, 0.7);

class EveryProjectionTest : public testing::TestWithParam<Projection> {};

TEST_P(EveryProjectionTest, PixelInvertsRayWhateverTheLengthOfTheRay) {
    const Projection p = GetParam();
    for (double x = -0.5; x < p.width_px - 0.5; x += 37.3) {
        for (double y = -20; y < p.height_px + 20; y += 23.7) {
            EXPECT_LT((p.Pixel(3.5 * p.Ray({x, y})) - Vector2d(x, y)).norm(), 1e-8)
                << x << ' ' << y;
        }
    }
}

TEST_P(EveryProjectionTest, ToPoseInvertsToOffset) {
    const Projection p = GetParam();
    cv::RNG random(2);
    for (int i = 0; i < 50; ++i) {
        const PoseOffset offset{
            {random.uniform(-300.0, 300.0),
             p.IsRing() ? random.uniform(-0.2, 0.2) : random.uniform(-90.0, 90.0),
             random.uniform(-0.2, 0.2)}};
        const PoseOffset back = ToOffset(p, ToPose(p, offset));
        EXPECT_LT((back.value - offset.value).norm(), 1e-8) << offset.value.transpose();
    }
    EXPECT_EQ(ToPose(p, {}), Matrix3d::Identity());
}

TEST_P(EveryProjectionTest, TheFirstComponentOfAnOffsetMovesThePictureToTheRightByThatManyPixels) {
    const Projection p = GetParam();
    const Matrix3d pose = ToPose(p, {{25, 0, 0}});
    for (const Vector2d& at : {Vector2d{300, 100}, Vector2d{17, p.Centre().y()}}) {
        const Vector2d moved = p.Pixel(pose * p.Ray(at));
        EXPECT_LT((moved - at - Vector2d{25, 0}).norm(), 1e-8) << at.transpose();
    }
}

TEST_P(EveryProjectionTest, TheScaledPictureShowsTheSameRaysAtTheSameShareOfItsSize) {
    const Projection p = GetParam();
    const Projection half = p.Scaled(0.5);
    EXPECT_EQ(half.width_px, p.width_px / 2);
    EXPECT_EQ(half.height_px, p.height_px / 2);
    if (!p.IsRing()) return;
    const Vector2d at{701, 99};
    const Vector2d at_half = (at.array() + 0.5) * 0.5 - 0.5;
    EXPECT_LT((half.Ray(at_half) - p.Ray(at)).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryProjectionTest, testing::Values(kPlane, kRing),
                         [](const auto& test) { return test.param.IsRing() ? "Ring" : "Plane"; });

TEST(CylinderTest, AzimuthGrowsToTheLeftAndElevationUpwards) {
    const Vector2d centre = kRing.Centre();
    const auto azimuth = [&](double x) {
        const Vector3d ray = kRing.Ray({x, 0});
        return std::atan2(ray.y(), ray.x());
    };
    EXPECT_NEAR(azimuth(centre.x()), 0.7, 1e-12);
    EXPECT_GT(azimuth(centre.x() - 50), 0.7);
    EXPECT_NEAR(azimuth(0) - azimuth(1), 2 * std::numbers::pi / 2048, 1e-12);
    EXPECT_GT(kRing.Ray({0, 10}).z(), 0);
    EXPECT_NEAR(kRing.Ray(centre).z(), 0, 1e-12);
    EXPECT_NEAR((centre.y() + 0.5) / 320, 0.4, 1e-12);
}

TEST(CylinderTest, OneTurnIsTheSamePixelAgain) {
    for (const double x : {0.0, 5.5, 1024.0, 2047.4}) {
        for (const int turns : {-2, -1, 1, 3}) {
            const Vector2d again = kRing.Pixel(kRing.Ray({x + 2048.0 * turns, 40}));
            EXPECT_LT((again - Vector2d{x, 40}).norm(), 1e-8) << x << ' ' << turns;
            EXPECT_NEAR(WrapColumn(x + 2048.0 * turns, 2048), x, 1e-9);
        }
    }
    EXPECT_DOUBLE_EQ(WrapColumn(-0.5, 2048), -0.5);
    EXPECT_DOUBLE_EQ(WrapColumn(2047.5, 2048), -0.5);
}

TEST(CylinderTest, DifferencesTakeTheShortWayRound) {
    EXPECT_LT((kRing.Difference({2, 7}, {2046, 4}) - Vector2d{4, 3}).norm(), 1e-12);
    EXPECT_LT((kRing.Difference({2046, 4}, {2, 7}) - Vector2d{-4, -3}).norm(), 1e-12);
    EXPECT_LT((kPlane.Difference({2, 7}, {630, 4}) - Vector2d{-628, 3}).norm(), 1e-12);
}

TEST(PlanePoseTest, ATurnIsAboutTheCentreAndClockwiseOnTheScreen) {
    const Matrix3d pose = ToPose(kPlane, {{0, 0, 0.1}});
    const Vector2d centre = kPlane.Centre();
    EXPECT_LT((kPlane.Pixel(pose * kPlane.Ray(centre)) - centre).norm(), 1e-10);
    const Vector2d right = kPlane.Pixel(pose * kPlane.Ray(centre + Vector2d{100, 0})) - centre;
    EXPECT_NEAR(right.x(), 100 * std::cos(0.1), 1e-10);
    EXPECT_NEAR(right.y(), 100 * std::sin(0.1), 1e-10);
}

TEST(PlanePoseTest, TheOffsetOfASimilarityLosesItsScaleOnly) {
    const PoseOffset offset{{12, -7, 0.15}};
    Matrix3d grow = Matrix3d::Identity();
    grow(0, 0) = grow(1, 1) = 1.2;
    grow.topRightCorner<2, 1>() = -0.2 * kPlane.Centre();  // about the centre
    const Matrix3d pose = ToPose(kPlane, offset) * grow;
    EXPECT_LT((ToOffset(kPlane, pose).value - offset.value).norm(), 1e-9);
    EXPECT_NEAR(ScaleOf(kPlane, pose), 1.2, 1e-12);
    EXPECT_EQ(ScaleOf(kRing, Matrix3d::Identity()), 1);
}

}  // namespace
}  // namespace hitchview::algo
