#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "algo/sight_table.hpp"
#include "tests/support/small_ring.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

/// Cameras that look back, so that their sights cross the edge of the view.
UnitGeometry Ring(int cameras, double apart_rad) {
    const Projection view = Projection::Cylinder(1024, 180, 0.48);
    return UnitGeometry::Ring(view, tests::LevelCameras(cameras, apart_rad, std::numbers::pi), {});
}

const CameraSight* Find(const UnitGeometry::Sights& sights, int camera) {
    for (const CameraSight& sight : sights) {
        if (sight.camera == camera) return &sight;
    }
    return nullptr;
}

/// Compares table and lens models at random pixels; returns how many sights were compared.
int Compare(const UnitGeometry& geometry, const CameraMask& present) {
    const SightTable table(geometry);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(-1500, 2500);  // whole turns off, too
    std::uniform_real_distribution<double> y(-20, 199);
    int compared = 0;
    UnitGeometry::Sights tabulated;
    UnitGeometry::Sights exact;
    for (int i = 0; i < 3000; ++i) {
        const Vector2d pixel(x(random), y(random));
        table.See(pixel, present, tabulated);
        geometry.See(geometry.view().Ray(pixel), present, exact);
        for (const CameraSight& sight : tabulated) {
            const CameraSight* other = Find(exact, sight.camera);
            EXPECT_NE(other, nullptr) << pixel.transpose();
            if (other == nullptr) continue;
            EXPECT_LT((sight.pixel - other->pixel).norm(), 0.1) << pixel.transpose();
            EXPECT_NEAR(sight.weight, other->weight, 0.02) << pixel.transpose();
            ++compared;
        }
        for (const CameraSight& sight : exact) {
            if (sight.weight < 0.01) continue;
            EXPECT_NE(Find(tabulated, sight.camera), nullptr) << pixel.transpose();
        }
    }
    return compared;
}

TEST(SightTableTest, ItSaysWhatTheLensesSayAlsoAcrossTheEdgeOfTheView) {
    EXPECT_GT(Compare(Ring(5, 1.2), CameraMask().set()), 4000);
}

TEST(SightTableTest, ACameraWithoutAPictureLeavesItsShareToTheOthers) {
    EXPECT_GT(Compare(Ring(5, 1.2), CameraMask(0b10111)), 4000);
}

TEST(SightTableTest, ASingleCameraIsSeenInItsOwnColumnsOnly) {
    const UnitGeometry geometry = Ring(1, 0);
    const SightTable table(geometry);
    UnitGeometry::Sights sights;
    table.See({0, 90}, CameraMask().set(), sights);
    EXPECT_EQ(sights.count(), 1) << "the rear lies at the view's edge";
    table.See({512, 90}, CameraMask().set(), sights);
    EXPECT_EQ(sights.count(), 0);
}

TEST(SightTableTest, FarAboveAndBelowTheViewThereIsNothing) {
    const SightTable table(Ring(5, 1.2));
    UnitGeometry::Sights sights;
    for (const double y : {-1000.0, 1000.0, 1e9, -1e9}) {
        table.See({0, y}, CameraMask().set(), sights);
        EXPECT_EQ(sights.count(), 0) << y;
    }
}

TEST(SightTableTest, APlanesPixelsAreItsCameras) {
    const SightTable table(UnitGeometry::Plane(320, 200));
    UnitGeometry::Sights sights;
    table.See({-12.5, 700.25}, CameraMask().set(), sights);
    ASSERT_EQ(sights.count(), 1);
    EXPECT_EQ(sights[0].pixel, Vector2d(-12.5, 700.25));
    EXPECT_EQ(sights[0].weight, 1);
    table.See({3, 4}, CameraMask(), sights);
    EXPECT_EQ(sights[0].weight, 0) << "it gives no picture";
}

}  // namespace
}  // namespace hitchview::algo
