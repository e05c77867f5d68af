#include "algo/composition.hpp"

namespace hitchview::algo {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d ToCanvas(const Projection& canvas, const Projection& view, const Composition& composition,
                  Unit unit, const Vector3d& view_ray) {
    const Vector2d view_px = view.Pixel(view_ray);
    constexpr int kSteps = 6;  // of the fixed points of what is read backwards
    const Mesh view_mesh(view);
    Vector2d moved = view_px;
    for (int i = 0; i < kSteps; ++i)
        moved = view_px + Sample(view_mesh, composition.view_offset[unit], moved);
    const Vector2d placed = canvas.Pixel(composition.M_canvas_view[unit] * view.Ray(moved));
    const double moves = unit == Unit::kTractor ? -composition.kappa : 1 - composition.kappa;
    const Mesh mesh(canvas);
    Vector2d shown = placed;
    for (int i = 0; i < kSteps; ++i)
        shown = placed - moves * Sample(mesh, composition.discrepancy, shown);
    return shown;
}

}  // namespace hitchview::algo
