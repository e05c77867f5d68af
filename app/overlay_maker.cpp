#include "app/overlay_maker.hpp"

#include <algorithm>
#include <limits>

namespace hitchview::app {
namespace {

using algo::Mesh;
using algo::Overlap;
using algo::Unit;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

bool IsSeen(const algo::UnitGeometry& geometry, const Eigen::Vector3d& ray) {
    algo::UnitGeometry::Sights sights;
    geometry.See(ray, sights);
    return std::ranges::any_of(sights, [](const auto& sight) { return sight.weight > 0; });
}

}  // namespace

OverlayMaker::OverlayMaker(const RigGeometry& rig, int block_px, hal::Instant period)
    : canvas_(rig.canvas),
      period_(period),
      mesh_x_(std::size_t{2} * Mesh::kVertices, kNotANumber),
      mesh_y_(mesh_x_) {
    composition_.detail = algo::CornerField(canvas_, Eigen::Vector2f::Zero());
    for (const Unit unit : algo::kUnits) {
        if (!rig.units[unit]) continue;
        UnitMesh& mesh = meshes_[unit].emplace();
        mesh.view = rig.units[unit]->view();
        const Mesh vertices(mesh.view);
        for (int i = 0; i < Mesh::kVertices; ++i) {
            mesh.rays.push_back(
                mesh.view.Ray(vertices.Vertex(i / Mesh::kVertexCols, i % Mesh::kVertexCols)));
            mesh.seen.push_back(IsSeen(*rig.units[unit], mesh.rays.back()));
        }
    }
    if (!rig.units[Unit::kTrailer]) return;
    for (int y = 0; y <= canvas_.height_px; y += block_px)
        seam_y_.push_back(static_cast<float>(y) - 0.5F);
    for (const Overlap overlap : algo::kOverlaps) {
        seam_x_[overlap].assign(seam_y_.size(), kNotANumber);
        told_seam_x_[overlap] = seam_x_[overlap];
    }
}

void OverlayMaker::Offer(const Shown& shown, const algo::Composition& composition,
                         const algo::ComposedMap& map, hal::Instant now) {
    if (now < next_at_ || left_.load(std::memory_order_acquire)) return;
    next_at_ = now + period_;
    shown_ = shown;
    Copy(composition, map);
    left_.store(true, std::memory_order_release);
}

void OverlayMaker::Copy(const algo::Composition& composition, const algo::ComposedMap& map) {
    composition_.M_canvas_view = composition.M_canvas_view;
    composition_.view_offset = composition.view_offset;
    composition_.discrepancy = composition.discrepancy;
    composition_.detail = composition.detail;
    composition_.kappa = composition.kappa;
    for (const Overlap overlap : algo::kOverlaps) {
        if (!map.is_ring() && overlap == Overlap::kLeft) continue;  // a plane has none
        for (std::size_t row = 0; row < seam_y_.size(); ++row)
            seam_x_[overlap][row] = static_cast<float>(map.seam_px(overlap, static_cast<int>(row)));
    }
}

std::optional<hal::Overlay> OverlayMaker::Take() {
    if (!left_.load(std::memory_order_acquire)) return std::nullopt;
    for (const Unit unit : algo::kUnits) Place(unit);
    told_seam_x_ = seam_x_;
    const hal::Overlay overlay{.sequence = shown_.sequence,
                               .captured_from = shown_.captured_from,
                               .width_px = canvas_.width_px,
                               .height_px = canvas_.height_px,
                               .mesh_rows = Mesh::kVertexRows,
                               .mesh_cols = Mesh::kVertexCols,
                               .mesh_x = mesh_x_,
                               .mesh_y = mesh_y_,
                               .seam_y = seam_y_,
                               .left_seam_x = told_seam_x_[Overlap::kLeft],
                               .right_seam_x = told_seam_x_[Overlap::kRight]};
    left_.store(false, std::memory_order_release);
    return overlay;
}

void OverlayMaker::Place(Unit unit) {
    if (!meshes_[unit]) return;
    const UnitMesh& mesh = *meshes_[unit];
    const std::size_t first = unit == Unit::kTractor ? 0 : std::size_t{Mesh::kVertices};
    for (std::size_t i = 0; i < mesh.rays.size(); ++i) {
        if (!mesh.seen[i]) continue;
        const Eigen::Vector2d shown =
            ToCanvas(canvas_, mesh.view, composition_, unit, mesh.rays[i]);
        mesh_x_[first + i] = static_cast<float>(shown.x());
        mesh_y_[first + i] = static_cast<float>(shown.y());
    }
}

}  // namespace hitchview::app
