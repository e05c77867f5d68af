#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "algo/camera_model.hpp"

namespace hitchview::algo {
namespace {

CameraModel Fisheye() {
    return {.kind = CameraModel::Kind::kKannalaBrandt4,
            .width_px = 1280,
            .height_px = 720,
            .fx_px = 560,
            .fy_px = 562,
            .cx_px = 641.3,
            .cy_px = 358.2,
            .distortion = {-0.02, 0.004, -0.001, 0.0002},
            .max_theta_rad = 1.5};
}

CameraModel Pinhole() {
    return {.kind = CameraModel::Kind::kPinholeRadtan,
            .width_px = 640,
            .height_px = 480,
            .fx_px = 536,
            .fy_px = 537,
            .cx_px = 342,
            .cy_px = 235,
            .distortion = {-0.27, -0.03, 0.0012, -0.0003, 0.2},
            .max_theta_rad = 0.65};
}

class CameraModelTest : public testing::TestWithParam<CameraModel> {};

TEST_P(CameraModelTest, UnprojectInvertsProject) {
    const CameraModel model = GetParam();
    for (double u = 20; u < model.width_px; u += 61) {
        for (double v = 20; v < model.height_px; v += 47) {
            const auto ray = model.Unproject({u, v});
            if (!ray) continue;
            EXPECT_NEAR(ray->norm(), 1, 1e-12);
            const auto pixel = model.Project(*ray * 7.5);
            ASSERT_TRUE(pixel) << u << ' ' << v;
            EXPECT_LT((*pixel - Eigen::Vector2d(u, v)).norm(), 1e-6) << u << ' ' << v;
        }
    }
    EXPECT_TRUE(model.Unproject({model.width_px / 2.0, model.height_px / 2.0}));
}

TEST_P(CameraModelTest, ARayBehindTheCameraHasNoPixel) {
    EXPECT_FALSE(GetParam().Project({0.1, 0.1, -1}));
}

INSTANTIATE_TEST_SUITE_P(Models, CameraModelTest, testing::Values(Fisheye(), Pinhole()));

TEST(CameraModelOracleTest, FisheyeAgreesWithOpenCv) {
    const CameraModel m = Fisheye();
    const std::vector<cv::Point3d> points{{1, 0.2, 3}, {-2, 1, 1}, {0.1, -0.4, 0.5}, {3, 0, 1}};
    std::vector<cv::Point2d> pixels;
    cv::fisheye::projectPoints(points, pixels, cv::Vec3d{}, cv::Vec3d{},
                               cv::Matx33d(m.fx_px, 0, m.cx_px, 0, m.fy_px, m.cy_px, 0, 0, 1),
                               cv::Vec4d(m.distortion.data()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto pixel = m.Project({points[i].x, points[i].y, points[i].z});
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x(), pixels[i].x, 1e-6);
        EXPECT_NEAR(pixel->y(), pixels[i].y, 1e-6);
    }
}

TEST(CameraModelOracleTest, PinholeAgreesWithOpenCv) {
    const CameraModel m = Pinhole();
    const std::vector<cv::Point3d> points{{0.3, 0.2, 3}, {-0.5, 0.3, 1.5}, {0.1, -0.4, 1}};
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(points, cv::Vec3d{}, cv::Vec3d{},
                      cv::Matx33d(m.fx_px, 0, m.cx_px, 0, m.fy_px, m.cy_px, 0, 0, 1),
                      cv::Mat(1, 5, CV_64F, const_cast<double*>(m.distortion.data())), pixels);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto pixel = m.Project({points[i].x, points[i].y, points[i].z});
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x(), pixels[i].x, 1e-6);
        EXPECT_NEAR(pixel->y(), pixels[i].y, 1e-6);
    }
}

}  // namespace
}  // namespace hitchview::algo
