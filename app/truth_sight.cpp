#include "app/truth_sight.hpp"

namespace hitchview::app {

using algo::Unit;
using Eigen::Vector2d;
using Eigen::Vector3d;

int TruthSight::RigCamera(Unit unit, int camera) const {
    return unit == Unit::kTractor ? camera : geometry_.units[Unit::kTractor]->cameras() + camera;
}

/// In the unit's view alone.
Sighting TruthSight::Locate(Unit unit, int camera, int frame, const Vector3d& p_world_m) const {
    const algo::UnitGeometry& geometry = *geometry_.units[unit];
    if (!rig_.CameraPresent(RigCamera(unit, camera), frame)) return {};
    const auto pixel = rig_.ProjectWorldPoint(RigCamera(unit, camera), frame, p_world_m);
    if (!pixel) return {};
    const auto ray = geometry.ViewRay(camera, *pixel);
    if (!ray) return {};
    algo::UnitGeometry::Sights sights;
    geometry.See(*ray, sights);
    for (const algo::CameraSight& sight : sights) {
        if (sight.camera == camera && sight.weight > 0)
            return {
                .camera = camera, .share = sight.weight, .view_px = geometry.view().Pixel(*ray)};
    }
    return {};
}

void TruthSight::Place(Unit unit, const algo::Composition& composition, Sighting& sighting) const {
    if (sighting.camera < 0) return;
    const algo::Projection& view = geometry_.units[unit]->view();
    sighting.canvas_px =
        algo::ToCanvas(geometry_.canvas, view, composition, unit, view.Ray(sighting.view_px));
}

Sighting TruthSight::Find(Unit unit, int frame, const Vector3d& p_world_m, Occlusion occlusion,
                          const algo::Composition& composition) {
    Sighting best;
    for (int i = 0; i < geometry_.units[unit]->cameras(); ++i) {
        const Sighting sighting = Locate(unit, i, frame, p_world_m);
        if (sighting.share > best.share) best = sighting;
    }
    if (best.camera >= 0 && occlusion == Occlusion::kTested &&
        IsHidden(unit, best.camera, frame, p_world_m)) {
        return {};
    }
    Place(unit, composition, best);
    return best;
}

bool TruthSight::IsHidden(Unit unit, int camera, int frame, const Vector3d& p_world_m) {
    return !OutlookOf(RigCamera(unit, camera), frame).IsFreeTo(p_world_m);
}

const drivers::Outlook& TruthSight::OutlookOf(int rig_camera, int frame) {
    if (frame != outlook_frame_) outlooks_ = {};
    outlook_frame_ = frame;
    auto& outlook = outlooks_[static_cast<std::size_t>(rig_camera)];
    if (!outlook) outlook = rig_.OutlookOf(rig_camera, frame);
    return *outlook;
}

std::optional<drivers::SimulatedRig::SeenPoint> TruthSight::WorldPointAt(Unit unit, int camera,
                                                                         int frame,
                                                                         const Vector2d& pixel) {
    const int rig_camera = RigCamera(unit, camera);
    return rig_.WorldPointAt(rig_camera, frame, pixel, OutlookOf(rig_camera, frame));
}

Sighting TruthSight::Through(Unit unit, int camera, int frame, const Vector3d& p_world_m,
                             const algo::Composition& composition) const {
    Sighting sighting = Locate(unit, camera, frame, p_world_m);
    Place(unit, composition, sighting);
    return sighting;
}

}  // namespace hitchview::app
