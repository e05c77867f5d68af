#include <gtest/gtest.h>

#include "algo/canvas_layout.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

const Projection kCanvas = Projection::Plane(1000, 500);
const Projection kTractor = Projection::Plane(400, 300);
const Projection kTrailer = Projection::Plane(300, 200);

Vector2d Moved(const Matrix3d& M, const Vector2d& pixel) {
    return (M * pixel.homogeneous()).hnormalized();
}

Matrix3d Shift(double x, double y) {
    Matrix3d M = Matrix3d::Identity();
    M(0, 2) = x;
    M(1, 2) = y;
    return M;
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

TEST(CanvasLayoutTest, ACoveredBorderZoomsAboutTheMiddleOfTheCanvas) {
    UnifiedVertexMotionOptions options;
    options.border = Border::kCovered;
    options.cropping = 0.8;
    const CanvasLayout free = LayOutCanvas(kCanvas, kTractor, {}, nullptr, {});
    const CanvasLayout covered = LayOutCanvas(kCanvas, kTractor, {}, nullptr, options);
    const Vector2d middle = kCanvas.Centre();
    for (const Vector2d& pixel : {Vector2d(0, 0), Vector2d(399, 10), Vector2d(120, 299)}) {
        const Vector2d arm = Moved(free.M_canvas_tractor, pixel) - middle;
        EXPECT_LT((Moved(covered.M_canvas_tractor, pixel) - middle - arm / 0.8).norm(), 1e-9);
    }
}

}  // namespace
}  // namespace hitchview::algo
