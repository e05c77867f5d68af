#include <gtest/gtest.h>

#include <numbers>

#include "algo/overlap_regions.hpp"

namespace hitchview::algo {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPxPerDegree = 2048.0 / 360;

/// Two pinhole cameras in one place on each unit: the tractor sees 100 degrees to each side of
/// straight ahead, the trailer 90 degrees to each side of straight back.
class OverlapRegionsTest : public testing::Test {
 protected:
    static constexpr double kHalfPicture_px = 400;

    static CameraGeometry Camera(double azimuth_deg, double half_angle_deg) {
        CameraGeometry camera;
        const double f_px = kHalfPicture_px / std::tan(half_angle_deg * kDegree);
        camera.model = {.kind = CameraModel::Kind::kPinholeRadtan,
                        .width_px = 800,
                        .height_px = 400,
                        .fx_px = f_px,
                        .fy_px = f_px,
                        .cx_px = 399.5,
                        .cy_px = 199.5,
                        .max_theta_rad = 1.2};
        const double a = azimuth_deg * kDegree;
        Eigen::Matrix3d R;  // columns: right, down, ahead
        R << std::sin(a), 0, std::cos(a), -std::cos(a), 0, std::sin(a), 0, -1, 0;
        camera.T_unit_camera = Eigen::Isometry3d::Identity();
        camera.T_unit_camera.linear() = R;
        camera.T_unit_camera.translation() = Eigen::Vector3d(0, 0, 1.3);
        return camera;
    }
    static UnitGeometry Look(double azimuth_deg, double half_view_deg) {
        const double half = half_view_deg / 2;
        const std::array cameras{Camera(azimuth_deg + half, half),
                                 Camera(azimuth_deg - half, half)};
        const auto view = Projection::Cylinder(2048, 240, 0.5, azimuth_deg * kDegree);
        return UnitGeometry::Ring(view, cameras, {});
    }
    /// An overlap of 10 degrees round 95 degrees on each side.
    const PerUnit<UnitGeometry> geometry_{{Look(0, 100), Look(180, 90)}};
    const PerUnit<SemiSurroundView> views_{{SemiSurroundView(geometry_[Unit::kTractor], 1.0),
                                            SemiSurroundView(geometry_[Unit::kTrailer], 1.0)}};
    const PerUnit<AnalysedRing> rings_{
        {AnalysedRing{&views_[Unit::kTractor], geometry_[Unit::kTractor].view()},
         AnalysedRing{&views_[Unit::kTrailer], geometry_[Unit::kTrailer].view()}}};

    static double Middle(const cv::Rect& region) { return region.x + 0.5 * region.width; }
    PerUnit<cv::Rect> Find(double heading_deg, Overlap overlap, double tolerance_deg = 0) const {
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(heading_deg * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        return OverlapRegions(rings_, turn, overlap, tolerance_deg * kDegree);
    }
};

TEST_F(OverlapRegionsTest, TheWidthIsWhatBothUnitsSeeOnOneSide) {
    for (const Overlap overlap : kOverlaps)
        EXPECT_NEAR(OverlapWidth_rad(geometry_, overlap), 10 * kDegree, 1 * kDegree);
}

TEST_F(OverlapRegionsTest, EachUnitsRegionLiesWhereTheOtherUnitSeesToo) {
    // 95 degrees left: left of the tractor's middle, right of the trailer's; 85 from straight back.
    const PerUnit<cv::Rect> left = Find(0, Overlap::kLeft);
    EXPECT_NEAR(Middle(left[Unit::kTractor]), 1024 - 95 * kPxPerDegree, 8);
    EXPECT_NEAR(Middle(left[Unit::kTrailer]), 1024 + 85 * kPxPerDegree, 8);
    const PerUnit<cv::Rect> right = Find(0, Overlap::kRight);
    EXPECT_NEAR(Middle(right[Unit::kTractor]), 1024 + 95 * kPxPerDegree, 8);
    EXPECT_NEAR(Middle(right[Unit::kTrailer]), 1024 - 85 * kPxPerDegree, 8);
    EXPECT_NEAR(left[Unit::kTractor].width, 10 * kPxPerDegree, 16);
    EXPECT_EQ(left[Unit::kTractor].height, 240);
}

TEST_F(OverlapRegionsTest, ATurnOfTheTrailerWidensOneOverlapAndClosesTheOther) {
    EXPECT_TRUE(Find(15, Overlap::kLeft)[Unit::kTractor].empty());
    EXPECT_NEAR(Find(15, Overlap::kRight)[Unit::kTractor].width, 25 * kPxPerDegree, 16);
}

TEST_F(OverlapRegionsTest, ToleranceIsAddedOnBothSidesButNotAcrossTheMiddle) {
    const cv::Rect exact = Find(0, Overlap::kLeft)[Unit::kTractor];
    const cv::Rect wider = Find(0, Overlap::kLeft, 5)[Unit::kTractor];
    EXPECT_NEAR(exact.x - wider.x, 5 * kPxPerDegree, 1);
    EXPECT_NEAR(wider.width - exact.width, 10 * kPxPerDegree, 2);
    const PerUnit<cv::Rect> whole = SideRegions(rings_, Overlap::kLeft);
    EXPECT_EQ(Find(0, Overlap::kLeft, 180)[Unit::kTractor], whole[Unit::kTractor]);
}

}  // namespace
}  // namespace hitchview::algo
