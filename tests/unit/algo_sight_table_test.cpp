#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

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

/// What the table says of pixels: a run of them, asked one by one.
class TabulatedRun {
 public:
    TabulatedRun(const SightTable& table, std::span<const Vector2d> pixels,
                 const CameraMask& present) {
        PixelRun run;
        run.count = static_cast<int>(pixels.size());
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            run.x_px[i] = static_cast<float>(pixels[i].x());
            run.y_px[i] = static_cast<float>(pixels[i].y());
        }
        table.See(run, present, sights_);
    }
    UnitGeometry::Sights operator[](int pixel) {
        UnitGeometry::Sights sights;
        const auto i = static_cast<std::size_t>(pixel);
        for (const CameraSightRun& run : sights_.cameras()) {
            if (pixel < run.first || pixel >= run.end || std::isnan(run.x_px[i])) continue;
            sights.push_back({run.camera, Vector2d(run.x_px[i], run.y_px[i]), run.share[i]});
        }
        return sights;
    }

 private:
    SightRuns sights_;
};

UnitGeometry::Sights SeeOne(const SightTable& table, const Vector2d& pixel,
                            const CameraMask& present = CameraMask().set()) {
    return TabulatedRun(table, {&pixel, 1}, present)[0];
}

const CameraSight* Find(const UnitGeometry::Sights& sights, int camera) {
    for (const CameraSight& sight : sights) {
        if (sight.camera == camera) return &sight;
    }
    return nullptr;
}

constexpr double kExact_px = 0.1;

/// Of a picture that is seen, above or below: on which side of it decides who is shown.
bool LiesOnAnEdge(const UnitGeometry& geometry, const UnitGeometry::Sights& sights) {
    for (const CameraSight& sight : sights) {
        const double y = sight.pixel.y();
        if (std::min(std::abs(y), std::abs(y - geometry.camera_height_px(sight.camera) + 1)) <
            kExact_px)
            return true;
    }
    return false;
}

/// Compares table and lens models at random pixels, in runs of up to the greatest length; returns
/// how many sights were compared.
int Compare(const UnitGeometry& geometry, const CameraMask& present) {
    const SightTable table(geometry);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(-1500, 2500);  // whole turns off, too
    std::uniform_real_distribution<double> y(-170, 349);  // 29 degrees beyond the view
    int compared = 0;
    UnitGeometry::Sights exact;
    for (std::size_t run = 0; run < 100; ++run) {
        std::vector<Vector2d> pixels(1 + run % PixelRun::kMost);
        for (Vector2d& pixel : pixels) pixel = {x(random), y(random)};
        TabulatedRun tabulated_run(table, pixels, present);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const Vector2d& pixel = pixels[i];
            const UnitGeometry::Sights tabulated = tabulated_run[static_cast<int>(i)];
            geometry.See(geometry.view().Ray(pixel), present, exact);
            for (const CameraSight& sight : tabulated) {
                const CameraSight* other = Find(exact, sight.camera);
                EXPECT_NE(other, nullptr) << pixel.transpose();
                if (other == nullptr) continue;
                EXPECT_LT((sight.pixel - other->pixel).norm(), kExact_px) << pixel.transpose();
                ++compared;
                if (LiesOnAnEdge(geometry, exact)) continue;
                EXPECT_NEAR(sight.weight, other->weight, 0.02) << pixel.transpose();
            }
            for (const CameraSight& sight : exact) {
                if (sight.weight < 0.01) continue;
                EXPECT_NE(Find(tabulated, sight.camera), nullptr) << pixel.transpose();
            }
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
    EXPECT_EQ(SeeOne(table, {0, 90}).count(), 1) << "the rear lies at the view's edge";
    EXPECT_EQ(SeeOne(table, {512, 90}).count(), 0);
}

TEST(SightTableTest, FarAboveAndBelowTheViewThereIsNothing) {
    const SightTable table(Ring(5, 1.2));
    for (const double y : {-1000.0, 1000.0, 1e9, -1e9})
        EXPECT_EQ(SeeOne(table, {0, y}).count(), 0) << y;
}

TEST(SightTableTest, APlanesPixelsAreItsCameras) {
    const SightTable table(UnitGeometry::Plane(320, 200));
    UnitGeometry::Sights sights = SeeOne(table, {-12.5, 700.25});
    ASSERT_EQ(sights.count(), 1);
    EXPECT_EQ(sights[0].pixel, Vector2d(-12.5, 700.25));
    EXPECT_EQ(sights[0].weight, 1);
    sights = SeeOne(table, {3, 4}, CameraMask());
    ASSERT_EQ(sights.count(), 1);
    EXPECT_EQ(sights[0].weight, 0) << "it gives no picture";
}

}  // namespace
}  // namespace hitchview::algo
