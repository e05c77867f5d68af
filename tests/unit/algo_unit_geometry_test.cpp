#include <gtest/gtest.h>

#include <array>

#include "algo/unit_geometry.hpp"
#include "tests/support/small_ring.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Projection kView = Projection::Cylinder(1024, 160, 0.5);
const AlignmentSurface kSurface{.radius_m = 15, .viewpoint_m = 1.2, .ground_m = -0.5};

UnitGeometry ThreeCameras() {
    return UnitGeometry::Ring(kView, tests::LevelCameras(3, 1.2, 0), kSurface);
}

std::array<double, kMaxCameras> SharesAt(const UnitGeometry& geometry, const Vector2d& pixel) {
    UnitGeometry::Sights sights;
    geometry.See(kView.Ray(pixel), sights);
    std::array<double, kMaxCameras> shares{};
    for (const CameraSight& sight : sights)
        shares[static_cast<std::size_t>(sight.camera)] = sight.weight;
    return shares;
}

TEST(AlignmentSurfaceTest, ARayHitsTheCylinderAboveTheHorizonAndTheGroundBelow) {
    for (double azimuth = -3; azimuth < 3; azimuth += 0.37) {
        const Vector3d level{std::cos(azimuth), std::sin(azimuth), 0};
        for (const double tan_elevation : {0.3, 0.0, -0.05, -0.2, -1.5}) {
            const Vector3d ray = 2.5 * (level + Vector3d{0, 0, tan_elevation});
            const Vector3d hit = kSurface.Hit(ray);
            EXPECT_GE(hit.z(), -0.5 - 1e-9);
            EXPECT_LE(hit.head<2>().norm(), 15 + 1e-9);
            EXPECT_TRUE(std::abs(hit.head<2>().norm() - 15) < 1e-9 ||
                        std::abs(hit.z() + 0.5) < 1e-9);
            const Vector3d from_viewpoint = hit - Vector3d{0, 0, 1.2};
            EXPECT_LT(from_viewpoint.cross(ray).norm(), 1e-8) << "the hit lies on the ray";
            EXPECT_GT(from_viewpoint.dot(ray), 0);
        }
    }
}

bool InPicture(const UnitGeometry& geometry, const CameraSight& sight) {
    return sight.pixel.x() >= 0 && sight.pixel.x() <= geometry.camera_width_px(sight.camera) - 1 &&
           sight.pixel.y() >= 0 && sight.pixel.y() <= geometry.camera_height_px(sight.camera) - 1;
}

TEST(UnitGeometryTest, SharesOfARayAddUpToOneWhereAnyCameraSeesIt) {
    const UnitGeometry geometry = ThreeCameras();
    UnitGeometry::Sights sights;
    int seen = 0;
    int blended = 0;
    for (double x = 0; x < kView.width_px; x += 3) {
        for (double y = 0; y < kView.height_px; y += 10) {
            geometry.See(kView.Ray({x, y}), sights);
            bool any = false;
            double sum = 0;
            int used = 0;
            for (const CameraSight& sight : sights) {
                EXPECT_GE(sight.weight, 0);
                EXPECT_TRUE(sight.weight == 0 || InPicture(geometry, sight));
                any = any || InPicture(geometry, sight);
                sum += sight.weight;
                used += sight.weight > 0 ? 1 : 0;
            }
            EXPECT_NEAR(sum, any ? 1 : 0, 1e-12);
            seen += any ? 1 : 0;
            blended += used > 1 ? 1 : 0;
        }
    }
    EXPECT_GT(seen, 1000);
    EXPECT_GT(blended, 10);
    EXPECT_LT(blended, seen / 4) << "cameras are blended in strips only";
}

TEST(UnitGeometryTest, ASightLineIsTheOneOfTheLensWithTheLargestShare) {
    const auto cameras = tests::LevelCameras(3, 1.2, 0);
    const UnitGeometry geometry = ThreeCameras();
    for (const double y : {20.0, 90.0, 150.0, 185.0}) {
        const Vector2d pixel{150, y};
        for (int i = 0; i < geometry.cameras(); ++i) {
            const CameraGeometry& camera = cameras[static_cast<std::size_t>(i)];
            const auto sight = geometry.SightAlong(*geometry.ViewRay(i, pixel));
            ASSERT_TRUE(sight);
            EXPECT_TRUE(sight->origin_m.isApprox(camera.T_unit_camera.translation()));
            const Vector3d direction =
                camera.T_unit_camera.linear() * *camera.model.Unproject(pixel);
            EXPECT_LT((sight->direction - direction).norm(), 1e-6);
        }
    }
    EXPECT_FALSE(geometry.SightAlong({-1, 0, 0})) << "nothing looks back";
}

TEST(UnitGeometryTest, ThePictureOfAPlaneIsItsView) {
    const UnitGeometry geometry = UnitGeometry::Plane(320, 200);
    for (const Vector2d& pixel : {Vector2d{0, 0}, Vector2d{12.25, 190}, Vector2d{-40, 500}}) {
        const Vector3d ray = geometry.view().Ray(pixel);
        Vector2d projected;
        ASSERT_TRUE(geometry.Project(0, ray, projected));
        EXPECT_TRUE(projected.isApprox(pixel) || (projected - pixel).norm() < 1e-9);
        UnitGeometry::Sights sights;
        geometry.See(ray, sights);
        ASSERT_EQ(sights.size(), 1U);
        EXPECT_EQ(sights[0].pixel, projected);
        EXPECT_EQ(geometry.ViewRay(0, pixel)->hnormalized(), projected);
    }
}

TEST(UnitGeometryTest, SharesChangeWithoutJumpsAlongTheHorizon) {
    const UnitGeometry geometry = ThreeCameras();
    constexpr double kStep_px = 0.05;
    auto last = SharesAt(geometry, {kView.Centre().x() - 250, 79.5});
    bool changed = false;
    for (double x = -250 + kStep_px; x < 250; x += kStep_px) {
        const auto now = SharesAt(geometry, {kView.Centre().x() + x, 79.5});
        for (std::size_t i = 0; i < kMaxCameras; ++i) {
            EXPECT_LT(std::abs(now[i] - last[i]), 0.02) << "camera " << i << " at " << x;
            changed = changed || now[i] != last[i];
        }
        last = now;
    }
    EXPECT_TRUE(changed);
}

TEST(UnitGeometryTest, EveryCameraHasTheMiddleOfItsOwnPictureToItself) {
    const UnitGeometry geometry = ThreeCameras();
    const std::array headings{1.2, 0.0, -1.2};
    for (int i = 0; i < 3; ++i) {
        const double heading = headings[static_cast<std::size_t>(i)];
        const Vector3d ray{std::cos(heading), std::sin(heading), 0};
        UnitGeometry::Sights sights;
        geometry.See(ray, sights);
        for (const CameraSight& sight : sights) {
            EXPECT_EQ(sight.weight, sight.camera == i ? 1 : 0);
            // The camera stands in the direction that it looks in: the ray is its optical axis.
            EXPECT_TRUE(sight.camera != i || std::abs(sight.pixel.x() - 159.5) < 1e-6);
        }
    }
}

TEST(UnitGeometryTest, APointOnTheAlignmentSurfaceIsSeenByTwoCamerasAtTheSameViewRay) {
    const auto cameras = tests::LevelCameras(3, 1.2, 0);
    const UnitGeometry geometry = UnitGeometry::Ring(kView, cameras, kSurface);
    UnitGeometry::Sights sights;
    int pairs = 0;
    for (double x = 0; x < kView.width_px; x += 2) {
        for (const double y : {50.0, 79.0, 110.0}) {
            const Vector3d ray = kView.Ray({x, y});
            geometry.See(ray, sights);
            if (sights.size() < 2) continue;
            ++pairs;
            const Vector3d point = kSurface.Hit(ray);
            for (const CameraSight& sight : sights) {
                const CameraGeometry& camera = cameras[static_cast<std::size_t>(sight.camera)];
                const auto direction = camera.model.Unproject(sight.pixel);
                ASSERT_TRUE(direction);
                const Vector3d seen = camera.T_unit_camera.linear() * *direction;
                const Vector3d wanted = point - camera.T_unit_camera.translation();
                EXPECT_LT(seen.cross(wanted.normalized()).norm(), 1e-7) << x << ' ' << y;
            }
        }
    }
    EXPECT_GT(pairs, 50);
}

TEST(UnitGeometryTest, BehindAllCamerasNothingIsSeen) {
    UnitGeometry::Sights sights;
    const UnitGeometry geometry = UnitGeometry::Ring(kView, tests::LevelCameras(1, 0, 0), kSurface);
    geometry.See({-1, 0, 0}, sights);
    EXPECT_TRUE(sights.empty());
    Vector2d pixel;
    EXPECT_FALSE(geometry.Project(0, {-1, 0, 0}, pixel));
}

TEST(UnitGeometryTest, APlanesOnlyCameraSeesEveryPixelAtItself) {
    const UnitGeometry geometry = UnitGeometry::Plane(640, 360);
    EXPECT_EQ(geometry.cameras(), 1);
    EXPECT_EQ(geometry.camera_width_px(0), 640);
    EXPECT_EQ(geometry.camera_height_px(0), 360);
    UnitGeometry::Sights sights;
    for (const Vector2d& pixel : {Vector2d{3.5, 7.25}, Vector2d{-50, 900}}) {
        geometry.See(geometry.view().Ray(pixel), sights);
        ASSERT_EQ(sights.count(), 1);
        EXPECT_EQ(sights[0].pixel, pixel);
        EXPECT_EQ(sights[0].weight, 1);
    }
}

}  // namespace
}  // namespace hitchview::algo
