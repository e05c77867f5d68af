#include "algo/composition.hpp"

namespace hitchview::algo {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d WholeDiscrepancy(const Mesh& mesh, const Composition& composition,
                          const Vector2d& canvas_px) {
    Vector2d e = Sample(mesh, composition.discrepancy, canvas_px);
    if (!composition.detail.empty()) e += composition.detail.Sample(canvas_px).cast<double>();
    return e;
}

Vector2d ToCanvas(const Projection& canvas, const Projection& view, const Composition& composition,
                  Unit unit, const Vector3d& view_ray) {
    const Vector2d view_px = view.Pixel(view_ray);
    constexpr int kSteps = 20;  // of the fixed points of what is read backwards
    const Mesh view_mesh(view);
    Vector2d moved = view_px;
    for (int i = 0; i < kSteps; ++i)
        moved = view_px + Sample(view_mesh, composition.view_offset[unit], moved);
    const Vector2d placed = canvas.Pixel(composition.M_canvas_view[unit] * view.Ray(moved));
    const double moves = unit == Unit::kTractor ? -composition.kappa : 1 - composition.kappa;
    const Mesh mesh(canvas);
    Vector2d shown = placed;
    for (int i = 0; i < kSteps; ++i)
        shown = placed - moves * WholeDiscrepancy(mesh, composition, shown);
    return shown;
}

}  // namespace hitchview::algo
