#include "algo/canvas_layout.hpp"

#include <algorithm>

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

/// The rectangle on the canvas that views side by side cover: pixels with their full extent.
struct Covered {
    Vector2d low;
    Vector2d high;
};

Covered CoveredBy(const Vector2d& view, const Matrix3d& M_canvas_view) {
    const auto corner = [&](const Vector2d& p) -> Vector2d {
        return (M_canvas_view * (p - Vector2d(0.5, 0.5)).homogeneous()).hnormalized();
    };
    const Vector2d a = corner({0, 0});
    const Vector2d b = corner({view.x(), 0});
    const Vector2d c = corner({0, view.y()});
    const Vector2d d = corner(view);
    return {{std::max(a.x(), c.x()), std::max(a.y(), b.y())},
            {std::min(b.x(), d.x()), std::min(c.y(), d.y())}};
}

/// From the first one's or the second one's outer side to the other's, where both have rows.
Covered SideBySide(const Covered& a, const Covered& b) {
    return {{std::min(a.low.x(), b.low.x()), std::max(a.low.y(), b.low.y())},
            {std::max(a.high.x(), b.high.x()), std::min(a.high.y(), b.high.y())}};
}

/// Fills the canvas from what is covered, also when each view has moved as far as its margin lets
/// it; `view`: size of the larger one. Never zooms less than by 1 / cropping.
Matrix3d ZoomToCover(const Projection& canvas, const Covered& covered, const Vector2d& view,
                     double cropping) {
    const Vector2d always = covered.high - covered.low - (1 - cropping) * view;
    double zoom = 1 / cropping;
    if (always.minCoeff() > 0) zoom = std::max(zoom, Size(canvas).cwiseQuotient(always).maxCoeff());
    const Vector2d middle = 0.5 * (covered.low + covered.high);
    return ZoomAbout(canvas.Centre(), zoom) * Shift(canvas.Centre() - middle);
}

/// The zoom of `border: covered` for a layout without it. Of units that were not found beside each
/// other nothing is known.
Matrix3d CoveringZoom(const Projection& canvas, const Projection& tractor,
                      const std::optional<Projection>& trailer, const Matrix3d* M_tractor_trailer,
                      const CanvasLayout& layout, double cropping) {
    if (trailer && M_tractor_trailer == nullptr) return ZoomAbout(canvas.Centre(), 1 / cropping);
    Vector2d view = Size(tractor);
    Covered covered = CoveredBy(view, layout.M_canvas_tractor);
    if (trailer) {
        const Matrix3d M_canvas_trailer = layout.M_canvas_tractor * *M_tractor_trailer;
        covered = SideBySide(covered, CoveredBy(Size(*trailer), M_canvas_trailer));
        view = view.cwiseMax(Size(*trailer));
    }
    return ZoomToCover(canvas, covered, view, cropping);
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
        const Matrix3d zoom =
            CoveringZoom(canvas, tractor, trailer, M_tractor_trailer, layout, options.cropping);
        layout.M_canvas_tractor = zoom * layout.M_canvas_tractor;
        layout.M_canvas_trailer = zoom * layout.M_canvas_trailer;
    }
    return layout;
}

}  // namespace hitchview::algo
