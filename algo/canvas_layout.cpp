#include "algo/canvas_layout.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

Matrix3d Shift(const Vector2d& by) {
    Matrix3d m = Matrix3d::Identity();
    m.topRightCorner<2, 1>() = by;
    return m;
}

Vector2d Size(const Projection& picture) {
    return {double(picture.width_px), double(picture.height_px)};
}

/// Middle of the box around the tractor's view and the trailer's where it lies on it.
Vector2d JointMiddle(const Vector2d& tractor, const Vector2d& trailer,
                     const Matrix3d& M_tractor_trailer) {
    Vector2d low = Vector2d::Zero();
    Vector2d high = tractor;
    for (const Vector2d& corner :
         {Vector2d(0, 0), Vector2d(trailer.x(), 0), Vector2d(0, trailer.y()), trailer}) {
        const Vector2d p = (M_tractor_trailer * corner.homogeneous()).hnormalized();
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return 0.5 * (low + high);
}

}  // namespace

CanvasLayout LayOutCanvas(const Projection& canvas, const Projection& tractor,
                          const std::optional<Projection>& trailer,
                          const Matrix3d* M_tractor_trailer,
                          const UnifiedVertexMotionOptions& options) {
    CanvasLayout layout;
    if (canvas.IsRing()) return layout;
    const Vector2d size = Size(canvas);
    if (!trailer) {
        layout.M_canvas_tractor = Shift(0.5 * (size - Size(tractor)));
    } else if (M_tractor_trailer != nullptr) {
        const Vector2d middle = JointMiddle(Size(tractor), Size(*trailer), *M_tractor_trailer);
        layout.M_canvas_tractor = Shift(0.5 * size - middle);
    } else {
        const Vector2d left = 0.5 * (size - Size(tractor));
        const Vector2d right = size - Size(*trailer);
        layout.M_canvas_tractor = Shift({0, left.y()});
        layout.M_canvas_trailer = Shift({right.x(), 0.5 * right.y()});
    }
    const auto& place = options.placement;
    if (place[Unit::kTractor]) layout.M_canvas_tractor = Shift(*place[Unit::kTractor]);
    if (place[Unit::kTrailer]) layout.M_canvas_trailer = Shift(*place[Unit::kTrailer]);
    if (options.border == Border::kCovered) {
        const Matrix3d zoom = ZoomAbout(canvas.Centre(), 1 / options.cropping);
        layout.M_canvas_tractor = zoom * layout.M_canvas_tractor;
        layout.M_canvas_trailer = zoom * layout.M_canvas_trailer;
    }
    return layout;
}

}  // namespace hitchview::algo
