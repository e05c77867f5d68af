#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "algo/picture_map.hpp"

namespace hitchview::algo {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

const Projection kView = Projection::Cylinder(1920, 480, 0.5);
const Projection kCanvas = Projection::Cylinder(1920, 512, 0.4);

/// Farthest that the grid is off anywhere in the view.
double WorstMiss_px(const Matrix3d& M_canvas_view) {
    PictureMap places(kView, kCanvas);
    SerialRunner runner;
    places.Update(M_canvas_view, runner);
    double worst_px = 0;
    for (double y = 0; y < kView.height_px; y += 3.7) {
        for (double x = 0; x < kView.width_px; x += 5.3) {
            const Vector2d exact = kCanvas.Pixel(M_canvas_view * kView.Ray({x, y}));
            worst_px = std::max(worst_px, kCanvas.Difference(places.At({x, y}), exact).norm());
        }
    }
    return worst_px;
}

TEST(PictureMapTest, TheGridIsRightEverywhereAlsoWhereTheViewCrossesTheCanvasEdge) {
    for (const double heading_rad : {0.0, 1.0, 3.1}) {
        const Matrix3d M = (AngleAxisd(heading_rad, Vector3d::UnitZ()) *
                            AngleAxisd(0.08, Vector3d(1, 1, 0).normalized()))
                               .toRotationMatrix();
        EXPECT_LT(WorstMiss_px(M), 0.03) << heading_rad;
    }
}

TEST(PictureMapTest, AnUpdateForgetsTheOneBefore) {
    PictureMap places(kView, kCanvas);
    SerialRunner runner;
    places.Update(AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix(), runner);
    places.Update(Matrix3d::Identity(), runner);
    const Vector2d pixel{700.25, 200.5};
    EXPECT_LT((places.At(pixel) - kCanvas.Pixel(kView.Ray(pixel))).norm(), 0.01);
}

TEST(PictureMapTest, ItsNodesAreExactInEveryDirection) {
    PictureMap places(kView, kCanvas);
    SerialRunner runner;
    for (int turn = 0; turn < 16; ++turn) {
        const Matrix3d M = (AngleAxisd(0.4 * turn, Vector3d::UnitZ()) *
                            AngleAxisd(0.1, Vector3d(1, 2, 0).normalized()))
                               .toRotationMatrix();
        places.Update(M, runner);
        for (int y = 0; y < kView.height_px; y += 16) {
            for (int x = 0; x < kView.width_px; x += 16) {
                const Vector2d exact = kCanvas.Pixel(M * kView.Ray({x, y}));
                EXPECT_LT(kCanvas.Difference(places.At({x, y}), exact).norm(), 1e-3)
                    << turn << ": " << x << ", " << y;
            }
        }
    }
}

}  // namespace
}  // namespace hitchview::algo
