#include "algo/composed_map.hpp"

#include <algorithm>
#include <cmath>

#include "algo/seam_detail.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Share of the unit beyond the seam: it fills what the preferred unit leaves uncovered.
constexpr float kFiller = 1e-3F;
/// Share of a camera without a picture where it would have seen something: the renderer then
/// knows, and any other camera outweighs it.
constexpr float kAbsent = 1e-6F;

bool Inside(const UnitGeometry& geometry, int camera, const Vector2d& pixel) {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= geometry.camera_width_px(camera) - 1 &&
           pixel.y() <= geometry.camera_height_px(camera) - 1;
}

}  // namespace

ComposedMap::ComposedMap(const Projection& canvas,
                         const PerUnit<std::optional<UnitGeometry>>& geometry,
                         const SeamOptions& seam)
    : canvas_(canvas),
      canvas_mesh_(canvas),
      geometry_(&geometry),
      rows_((canvas.height_px + kBlock - 1) / kBlock + 1),
      cols_((canvas.width_px + kBlock - 1) / kBlock + 1),
      seams_(canvas, rows_, cols_, kBlock, seam),
      seam_cost_(rows_ * cols_, {}),
      shown_detail_(canvas, Eigen::Vector2f::Zero()) {
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
    for (const Unit unit : kUnits) present_[unit].set();
    BuildFor(composition, nullptr, runner);
}

void ComposedMap::Build(const Composition& composition, const RigPictures& pictures,
                        TaskRunner& runner) {
    for (const Unit unit : kUnits) {
        for (std::size_t i = 0; i < kMaxCameras; ++i)
            present_[unit][i] = pictures.frames[unit][i].present();
    }
    BuildFor(composition, &pictures, runner);
}

void ComposedMap::BuildFor(const Composition& composition, const RigPictures* pictures,
                           TaskRunner& runner) {
    for (const Unit unit : kUnits) M_view_canvas_[unit] = composition.M_canvas_view[unit].inverse();
    runner.Run(rows_, [&](int row) { LocateRow(composition, row); });
    UpdateSeams(composition, pictures, runner);
    FadeDetail(composition, runner);
    selected_.reset();
    runner.Run(rows_, [&](int row) { WeightRow(row); });
}

void ComposedMap::LocateRow(const Composition& composition, int row) {
    for (const Unit unit : kUnits) {
        if (!(*geometry_)[unit]) continue;
        for (int col = 0; col < cols_; ++col) {
            LocateCorner(composition, unit, row, col,
                         WholeDiscrepancy(canvas_mesh_, composition, CornerPixel(row, col)));
        }
    }
}

/// The seams were chosen with all of the detail everywhere.
void ComposedMap::FadeDetail(const Composition& composition, TaskRunner& runner) {
    shown_detail_ = composition.detail;
    if (shown_detail_.empty() || !(*geometry_)[Unit::kTrailer]) return;
    FadeFromSeams(canvas_mesh_, composition.discrepancy, composition.detail, seams_,
                  {.kappa = composition.kappa}, runner, shown_detail_);
    runner.Run(rows_, [&](int row) { LocateFadedRow(composition, row); });
}

void ComposedMap::LocateFadedRow(const Composition& composition, int row) {
    constexpr float kNoChange_px = 0.02F;
    for (int col = 0; col < cols_; ++col) {
        const Eigen::Vector2f& shown = shown_detail_.at(row, col);
        if ((shown - composition.detail.at(row, col)).cwiseAbs().maxCoeff() < kNoChange_px)
            continue;
        const Vector2d e = Sample(canvas_mesh_, composition.discrepancy, CornerPixel(row, col)) +
                           shown.cast<double>();
        for (const Unit unit : kUnits) LocateCorner(composition, unit, row, col, e);
    }
}

void ComposedMap::LocateCorner(const Composition& composition, Unit unit, int row, int col,
                               const Vector2d& e) {
    const UnitGeometry& geometry = *(*geometry_)[unit];
    const std::size_t at = At(row, col);
    const Vector2d canvas_px = CornerPixel(row, col);
    const double moves = unit == Unit::kTractor ? -composition.kappa : 1 - composition.kappa;
    Vector3d ray = M_view_canvas_[unit] * canvas_.Ray(canvas_px + moves * e);
    const Vector2d view_px = geometry.view().Pixel(ray);
    const Mesh view_mesh(geometry.view());
    ray = geometry.view().Ray(view_px - Sample(view_mesh, composition.view_offset[unit], view_px));

    UnitGeometry::Sights sights;
    geometry.See(ray, present_[unit], sights);
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
        if (!Inside(geometry, sight.camera, sight.pixel)) continue;
        if (sight.weight > 0) covered_[unit][at] = 1;
        if (!present_[unit][static_cast<std::size_t>(sight.camera)]) source.share[at] = kAbsent;
    }
}

void ComposedMap::UpdateSeams(const Composition& composition, const RigPictures* pictures,
                              TaskRunner& runner) {
    if (!(*geometry_)[Unit::kTrailer]) return;
    seams_.FindOverlaps(covered_);
    if (pictures != nullptr)
        runner.Run(rows_, [&](int row) { CompareUnits(composition, *pictures, row); });
    if (!canvas_.IsRing()) {
        PerUnit<double> middle_px;
        for (const Unit unit : kUnits) {
            const Projection& view = (*geometry_)[unit]->view();
            middle_px[unit] =
                canvas_.Pixel(composition.M_canvas_view[unit] * view.Ray(view.Centre())).x();
        }
        seams_.PlaceViews(middle_px);
    }
    seams_.Follow(pictures != nullptr ? seam_cost_.cost() : std::span<const float>());
}

void ComposedMap::CompareUnits(const Composition& composition, const RigPictures& pictures,
                               int row) {
    for (const Overlap overlap : kOverlaps) {
        const SeamPath::Range& range = seams_.overlap(overlap);
        for (int col = range.first; col <= range.last; ++col) {
            const std::size_t at = At(row, col);
            if (covered_[Unit::kTractor][at] == 0 || covered_[Unit::kTrailer][at] == 0) {
                seam_cost_.ObserveOne(at);
                continue;
            }
            seam_cost_.ObserveBoth(
                at, PatchOf(pictures, Unit::kTractor, at), PatchOf(pictures, Unit::kTrailer, at),
                {BendAt(composition, CornerPixel(row, col)), DoubtAt(composition, row, col)});
        }
    }
}

/// From the camera that has the largest share; the unit covers the corner.
GreyPatch ComposedMap::PatchOf(const RigPictures& pictures, Unit unit, std::size_t at) const {
    const Source* best = &sources_[static_cast<std::size_t>(first_source_[unit])];
    for (const Source& source : sources_) {
        if (source.unit == unit && source.share[at] > best->share[at]) best = &source;
    }
    const auto camera = static_cast<std::size_t>(best->camera);
    return ReadGreyPatch(pictures.frames[unit][camera], pictures.gains[unit][camera],
                         best->corners[at].x, best->corners[at].y);
}

float ComposedMap::DoubtAt(const Composition& composition, int row, int col) const {
    return composition.doubt_px.empty() ? 0 : composition.doubt_px.at(row, col);
}

float ComposedMap::BendAt(const Composition& composition, const Vector2d& pixel) const {
    const auto slope = [&](const Vector2d& step) {
        return (WholeDiscrepancy(canvas_mesh_, composition, pixel + step) -
                WholeDiscrepancy(canvas_mesh_, composition, pixel - step))
                   .norm() /
               (2 * step.norm());
    };
    const double kStep = composition.detail.empty() ? 2 * kBlock : kBlock;
    return static_cast<float>(slope({kStep, 0}) + slope({0, kStep}));
}

void ComposedMap::WeightRow(int row) {
    const bool two = (*geometry_)[Unit::kTrailer].has_value();
    for (int col = 0; col < cols_; ++col) {
        const std::size_t at = At(row, col);
        const auto tractor =
            static_cast<float>(two ? seams_.TractorShare(row, CornerPixel(row, col).x()) : 1.0);
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
