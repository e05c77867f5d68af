#include "algo/composition.hpp"

namespace hitchview::algo {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d ToCanvas(const Projection& canvas, const Projection& view, const Composition& composition,
                  Unit unit, const Vector3d& view_ray) {
    const Vector2d view_px = view.Pixel(view_ray);
    const Vector2d moved = view_px + Sample(Mesh(view), composition.view_offset[unit], view_px);
    const Vector2d placed = canvas.Pixel(composition.M_canvas_view[unit] * view.Ray(moved));
    const double moves = unit == Unit::kTractor ? -composition.kappa : 1 - composition.kappa;
    const Mesh mesh(canvas);
    constexpr int kSteps = 6;  // fixed point of shown = placed - moves e(shown)
    Vector2d shown = placed;
    for (int i = 0; i < kSteps; ++i)
        shown = placed - moves * Sample(mesh, composition.discrepancy, shown);
    return shown;
}

}  // namespace hitchview::algo
