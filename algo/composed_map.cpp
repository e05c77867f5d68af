#include "algo/composed_map.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Share of the unit beyond the seam: it fills what the preferred unit leaves uncovered.
constexpr float kFiller = 1e-3F;
/// A column belongs to the overlap if this share of its corners is covered by both units.
constexpr double kOverlapShare = 0.6;

bool Inside(const UnitGeometry& geometry, int camera, const Vector2d& pixel) {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= geometry.camera_width_px(camera) - 1 &&
           pixel.y() <= geometry.camera_height_px(camera) - 1;
}

double SmoothStep(double t) {
    const double s = std::clamp(t, 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

}  // namespace

ComposedMap::ComposedMap(const Projection& canvas,
                         const PerUnit<std::optional<UnitGeometry>>& geometry,
                         const SeamOptions& seam)
    : canvas_(canvas),
      canvas_mesh_(canvas),
      geometry_(&geometry),
      seam_(seam),
      rows_((canvas.height_px + kBlock - 1) / kBlock + 1),
      cols_((canvas.width_px + kBlock - 1) / kBlock + 1) {
    const auto corners = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_);
    for (const Unit unit : kUnits) {
        first_source_[unit] = static_cast<int>(sources_.size());
        covered_[unit].assign(corners, 0);
        if (!geometry[unit]) continue;
        for (int i = 0; i < geometry[unit]->cameras(); ++i) {
            sources_.push_back(
                {unit, i, std::vector<Corner>(corners), std::vector<float>(corners)});
        }
    }
}

void ComposedMap::Build(const Composition& composition, TaskRunner& runner) {
    for (const Unit unit : kUnits) M_view_canvas_[unit] = composition.M_canvas_view[unit].inverse();
    runner.Run(rows_, [&](int row) { LocateRow(composition, row); });
    UpdateSeams(composition);
    selected_.reset();
    runner.Run(rows_, [&](int row) { WeightRow(row); });
}

void ComposedMap::LocateRow(const Composition& composition, int row) {
    for (const Unit unit : kUnits) {
        if (!(*geometry_)[unit]) continue;
        for (int col = 0; col < cols_; ++col) LocateCorner(composition, unit, row, col);
    }
}

void ComposedMap::LocateCorner(const Composition& composition, Unit unit, int row, int col) {
    const UnitGeometry& geometry = *(*geometry_)[unit];
    const std::size_t at = At(row, col);
    const Vector2d canvas_px = CornerPixel(row, col);
    const double moves = unit == Unit::kTractor ? -composition.kappa : 1 - composition.kappa;
    const Vector2d met =
        canvas_px + moves * Sample(canvas_mesh_, composition.discrepancy, canvas_px);
    Vector3d ray = M_view_canvas_[unit] * canvas_.Ray(met);
    const Vector2d view_px = geometry.view().Pixel(ray);
    const Mesh view_mesh(geometry.view());
    ray = geometry.view().Ray(view_px - Sample(view_mesh, composition.view_offset[unit], view_px));

    UnitGeometry::Sights sights;
    geometry.See(ray, sights);
    for (int i = 0; i < geometry.cameras(); ++i) {
        Source& source = sources_[static_cast<std::size_t>(first_source_[unit] + i)];
        source.corners[at].sees = false;
        source.share[at] = 0;
    }
    covered_[unit][at] = 0;
    for (const CameraSight& sight : sights) {
        Source& source = sources_[static_cast<std::size_t>(first_source_[unit] + sight.camera)];
        source.corners[at] = {static_cast<float>(sight.pixel.x()),
                              static_cast<float>(sight.pixel.y()), 0, true};
        source.share[at] = static_cast<float>(sight.weight);
        if (sight.weight > 0 && Inside(geometry, sight.camera, sight.pixel)) covered_[unit][at] = 1;
    }
}

double ComposedMap::MiddleOfOverlap(int from_col, int to_col, bool& known) const {
    int first = -1;
    int last = -1;
    for (int col = from_col; col < to_col; ++col) {
        int both = 0;
        int any = 0;
        for (int row = 0; row < rows_; ++row) {
            const bool tractor = covered_[Unit::kTractor][At(row, col)] != 0;
            const bool trailer = covered_[Unit::kTrailer][At(row, col)] != 0;
            both += tractor && trailer ? 1 : 0;
            any += tractor || trailer ? 1 : 0;
        }
        if (any == 0 || both < kOverlapShare * any) continue;
        if (first < 0) first = col;
        last = col;
    }
    known = first >= 0;
    return 0.5 * (first + last) * kBlock - 0.5;
}

void ComposedMap::SetSeam(Overlap overlap, double target, bool known) {
    if (!known) return;
    double& seam = seam_px_[overlap];
    seam = seam_known_[overlap] ? seam + seam_.tracking_gain * (target - seam) : target;
    seam_known_[overlap] = true;
}

void ComposedMap::UpdateSeams(const Composition& composition) {
    if (!(*geometry_)[Unit::kTrailer]) return;
    bool known = false;
    if (canvas_.IsRing()) {
        const double left = MiddleOfOverlap(0, cols_ / 2, known);
        SetSeam(Overlap::kLeft, left, known);
        const double right = MiddleOfOverlap(cols_ / 2, cols_, known);
        SetSeam(Overlap::kRight, right, known);
        return;
    }
    const auto middle = [&](Unit unit) {
        const Projection& view = (*geometry_)[unit]->view();
        return canvas_.Pixel(composition.M_canvas_view[unit] * view.Ray(view.Centre())).x();
    };
    trailer_left_ = middle(Unit::kTrailer) < middle(Unit::kTractor);
    const double seam = MiddleOfOverlap(0, cols_, known);
    // Without an overlap the seam lies half way between the two views.
    SetSeam(Overlap::kRight, known ? seam : 0.5 * (middle(Unit::kTrailer) + middle(Unit::kTractor)),
            true);
}

double ComposedMap::TractorShare(double x) const {
    const double width = 2 * seam_.half_width_px;
    const auto beyond = [&](double seam) { return SmoothStep((x - seam) / width + 0.5); };
    if (!canvas_.IsRing()) {
        const double right_of_seam = beyond(seam_px_[Overlap::kRight]);
        return trailer_left_ ? right_of_seam : 1 - right_of_seam;
    }
    return std::min(beyond(seam_px_[Overlap::kLeft]), 1 - beyond(seam_px_[Overlap::kRight]));
}

void ComposedMap::WeightRow(int row) {
    const bool two = (*geometry_)[Unit::kTrailer].has_value();
    for (int col = 0; col < cols_; ++col) {
        const std::size_t at = At(row, col);
        const auto tractor =
            static_cast<float>(two ? TractorShare(CornerPixel(row, col).x()) : 1.0);
        PerUnit<float> share{{tractor, 1 - tractor}};
        if (selected_) {
            share[*selected_] = 1;
            share[Other(*selected_)] = 0;
        } else if (two) {
            for (const Unit unit : kUnits) {
                if (covered_[Other(unit)][at] == 0) share[unit] = std::max(share[unit], kFiller);
            }
        }
        for (Source& source : sources_)
            source.corners[at].weight = share[source.unit] * source.share[at];
    }
}

void ComposedMap::SelectUnit(Unit unit) {
    selected_ = unit;
    for (int row = 0; row < rows_; ++row) WeightRow(row);
}

void ComposedMap::SelectBoth() {
    selected_.reset();
    for (int row = 0; row < rows_; ++row) WeightRow(row);
}

}  // namespace hitchview::algo
