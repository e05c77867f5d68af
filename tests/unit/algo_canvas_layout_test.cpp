#include <gtest/gtest.h>

#include "algo/canvas_layout.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

const Projection kCanvas = Projection::Plane(1000, 500);
const Projection kTractor = Projection::Plane(400, 300);
const Projection kTrailer = Projection::Plane(300, 200);
const Projection kView = Projection::Plane(480, 400);

Vector2d Moved(const Matrix3d& M, const Vector2d& pixel) {
    return (M * pixel.homogeneous()).hnormalized();
}

Matrix3d Shift(double x, double y) {
    Matrix3d M = Matrix3d::Identity();
    M(0, 2) = x;
    M(1, 2) = y;
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

TEST(CanvasLayoutTest, ARingLiesInTheTractorsFrame) {
    const Projection ring = Projection::Cylinder(1000, 180, 0.5);
    UnifiedVertexMotionOptions options;
    options.border = Border::kCovered;
    const CanvasLayout layout = LayOutCanvas(ring, ring, ring, nullptr, options);
    EXPECT_TRUE(layout.M_canvas_tractor.isIdentity(0));
    EXPECT_TRUE(layout.M_canvas_trailer.isIdentity(0));
}

TEST(CanvasLayoutTest, AViewAloneStandsInTheMiddle) {
    const CanvasLayout layout = LayOutCanvas(kCanvas, kTractor, {}, nullptr, {});
    EXPECT_TRUE(layout.M_canvas_tractor.isApprox(Shift(300, 100)));
}

TEST(CanvasLayoutTest, ViewsThatWereNotMatchedLieFlushLeftAndFlushRight) {
    const CanvasLayout layout = LayOutCanvas(kCanvas, kTractor, kTrailer, nullptr, {});
    EXPECT_TRUE(layout.M_canvas_tractor.isApprox(Shift(0, 100)));
    EXPECT_TRUE(layout.M_canvas_trailer.isApprox(Shift(700, 150)));
}

TEST(CanvasLayoutTest, TheBoxAroundMatchedViewsStandsInTheMiddle) {
    // The trailer's view reaches from (350, -40) to (650, 160) of the tractor's.
    const Matrix3d M_tractor_trailer = Shift(350, -40);
    const CanvasLayout layout = LayOutCanvas(kCanvas, kTractor, kTrailer, &M_tractor_trailer, {});
    EXPECT_TRUE(layout.M_canvas_tractor.isApprox(Shift(500 - 325, 250 - 130)))
        << layout.M_canvas_tractor;
}

TEST(CanvasLayoutTest, APlaceThatIsGivenHoldsWhateverWasMatched) {
    UnifiedVertexMotionOptions options;
    options.placement[Unit::kTrailer] = Vector2d(610, 20);
    const Matrix3d M_tractor_trailer = Shift(350, 0);
    const CanvasLayout layout =
        LayOutCanvas(kCanvas, kTractor, kTrailer, &M_tractor_trailer, options);
    EXPECT_TRUE(layout.M_canvas_trailer.isApprox(Shift(610, 20)));
    options.placement[Unit::kTractor] = Vector2d(5, 6);
    EXPECT_TRUE(LayOutCanvas(kCanvas, kTractor, kTrailer, &M_tractor_trailer, options)
                    .M_canvas_tractor.isApprox(Shift(5, 6)));
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
    EXPECT_NEAR(Moved(layout.M_canvas_tractor, {margin_px - 0.5, 0}).x(), -0.5, 1e-9);
    EXPECT_NEAR(Moved(layout.M_canvas_tractor, {479.5 - margin_px, 0}).x(), 1099.5, 1e-9);
}

TEST(CanvasLayoutTest, TwoViewsSideBySideFillTheCanvasWhereBothHaveRows) {
    const Projection canvas = Projection::Plane(1100, 520);
    for (const double side : {1.0, -1.0}) {  // the trailer to the right, to the left
        const Matrix3d M_tractor_trailer = Shift(side * 360, 10);
        const CanvasLayout layout = Covering(canvas, &M_tractor_trailer);
        const Matrix3d M_canvas_trailer = layout.M_canvas_tractor * M_tractor_trailer;
        const double margin_px = 0.5 * (1 - 0.9) * kView.height_px;
        EXPECT_NEAR(Moved(M_canvas_trailer, {0, margin_px - 0.5}).y(), -0.5, 1e-9);
        EXPECT_NEAR(Moved(layout.M_canvas_tractor, {0, 399.5 - margin_px}).y(), 519.5, 1e-9);
        const Matrix3d& left = side > 0 ? layout.M_canvas_tractor : M_canvas_trailer;
        const Matrix3d& right = side > 0 ? M_canvas_trailer : layout.M_canvas_tractor;
        EXPECT_LT(Moved(left, {24, 0}).x(), 0);
        EXPECT_GT(Moved(right, {479 - 24, 0}).x(), 1099);
    }
}

}  // namespace
}  // namespace hitchview::algo
