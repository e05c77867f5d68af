#include <gtest/gtest.h>

#include "algo/canvas_layout.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

const Projection kView = Projection::Plane(480, 400);

Vector2d Apply(const Matrix3d& M, const Vector2d& pixel) {
    return (M * pixel.homogeneous()).hnormalized();
}

Matrix3d Beside(double x_px, double y_px) {
    Matrix3d M = Matrix3d::Identity();
    M.topRightCorner<2, 1>() << x_px, y_px;
    return M;
}

CanvasLayout Covering(const Projection& canvas, const Matrix3d* M_tractor_trailer,
                      double cropping = 0.9) {
    UnifiedVertexMotionOptions options;
    options.border = Border::kCovered;
    options.cropping = cropping;
    const std::optional<Projection> trailer =
        M_tractor_trailer ? std::optional(kView) : std::nullopt;
    return LayOutCanvas(canvas, kView, trailer, M_tractor_trailer, options);
}

TEST(CanvasLayoutTest, AViewAsLargeAsItsCanvasIsZoomedByTheCroppingAboutItsMiddle) {
    const CanvasLayout layout = Covering(kView, nullptr, 0.8);
    EXPECT_TRUE(layout.M_canvas_tractor.isApprox(ZoomAbout(kView.Centre(), 1.25), 1e-12));
}

TEST(CanvasLayoutTest, ASmallerCanvasIsZoomedNoLessThanThat) {
    const CanvasLayout layout = Covering(Projection::Plane(240, 200), nullptr);
    EXPECT_NEAR(layout.M_canvas_tractor(0, 0), 1 / 0.9, 1e-12);
}

TEST(CanvasLayoutTest, ALargerCanvasIsFilledAlsoWhenTheViewUsesItsMargin) {
    const Projection canvas = Projection::Plane(1100, 520);
    const CanvasLayout layout = Covering(canvas, nullptr);
    const double margin_px = 0.5 * (1 - 0.9) * kView.width_px;
    EXPECT_NEAR(Apply(layout.M_canvas_tractor, {margin_px - 0.5, 0}).x(), -0.5, 1e-9);
    EXPECT_NEAR(Apply(layout.M_canvas_tractor, {479.5 - margin_px, 0}).x(), 1099.5, 1e-9);
}

TEST(CanvasLayoutTest, TwoViewsSideBySideFillTheCanvasWhereBothHaveRows) {
    const Projection canvas = Projection::Plane(1100, 520);
    for (const double side : {1.0, -1.0}) {  // the trailer to the right, to the left
        const Matrix3d M_tractor_trailer = Beside(side * 360, 10);
        const CanvasLayout layout = Covering(canvas, &M_tractor_trailer);
        const Matrix3d M_canvas_trailer = layout.M_canvas_tractor * M_tractor_trailer;
        const double margin_px = 0.5 * (1 - 0.9) * kView.height_px;
        EXPECT_NEAR(Apply(M_canvas_trailer, {0, margin_px - 0.5}).y(), -0.5, 1e-9);
        EXPECT_NEAR(Apply(layout.M_canvas_tractor, {0, 399.5 - margin_px}).y(), 519.5, 1e-9);
        const Matrix3d& left = side > 0 ? layout.M_canvas_tractor : M_canvas_trailer;
        const Matrix3d& right = side > 0 ? M_canvas_trailer : layout.M_canvas_tractor;
        EXPECT_LT(Apply(left, {24, 0}).x(), 0);
        EXPECT_GT(Apply(right, {479 - 24, 0}).x(), 1099);
    }
}

}  // namespace
}  // namespace hitchview::algo
