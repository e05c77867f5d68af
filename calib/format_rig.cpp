#include "calib/format_rig.hpp"

#include <charconv>
#include <cmath>

namespace hitchview::calib {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Why the places of a file cannot be taken; empty if they can.
std::string Refusal(const UnitCameras& file, bool has_first) {
    for (const ForeignCamera& camera : file.foreign.cameras) {
        if (!camera.T_reference_camera)
            return file.file + ": the format does not tell where " + camera.name +
                   " stands; without --unit its lens is imported";
        if (!has_first && camera.T_reference_camera->isApprox(Isometry3d::Identity(), 1e-9))
            return file.file + ": the places are those in the frame of " + camera.name +
                   ", must be in the unit's; say with --first-camera where the first camera stands";
    }
    return "";
}

std::string Refusal(const std::vector<UnitCameras>& files, bool has_first) {
    for (const UnitCameras& file : files) {
        if (std::string why = Refusal(file, has_first); !why.empty()) return why;
        if (has_first && file.unit != files.front().unit)
            return file.file +
                   ": --first-camera is for cameras of one unit, must be imported alone";
        if (has_first && file.foreign.from_first_camera && files.size() > 1)
            return file.file + ": the chain has a first camera of its own, must be imported alone";
    }
    return "";
}

}  // namespace

AssembledRig AssembleRig(const std::vector<UnitCameras>& files, const std::string& vehicle,
                         const std::optional<Isometry3d>& T_unit_first) {
    AssembledRig rig{.error = Refusal(files, T_unit_first.has_value())};
    if (!rig.error.empty()) return rig;
    Isometry3d T_unit_reference = Isometry3d::Identity();
    if (T_unit_first)
        T_unit_reference =
            *T_unit_first * files.front().foreign.cameras.front().T_reference_camera->inverse();
    RigCalibration calibration{.vehicle = vehicle};
    for (const UnitCameras& file : files) {
        for (const ForeignCamera& camera : file.foreign.cameras) {
            const CalibratedCamera placed = CalibratedCamera::From(
                file.unit, {camera.model, T_unit_reference * *camera.T_reference_camera});
            if (!calibration.cameras.emplace(camera.name, placed).second)
                return {std::nullopt, file.file + ": " + camera.name +
                                          " is the name of two cameras, must be of one"};
        }
    }
    rig.calibration = std::move(calibration);
    return rig;
}

std::optional<Isometry3d> ParseCameraPlace(std::string_view text) {
    constexpr double kMost = 360;
    std::array<double, 6> n{};
    for (std::size_t i = 0; i < n.size(); ++i) {
        const char* const end = text.data() + text.size();
        const auto parsed = std::from_chars(text.data(), end, n[i]);
        const bool last = i + 1 == n.size();
        if (parsed.ec != std::errc{} || !(std::abs(n[i]) <= kMost)) return std::nullopt;
        if (last != (parsed.ptr == end) || (!last && *parsed.ptr != ',')) return std::nullopt;
        text.remove_prefix(static_cast<std::size_t>(parsed.ptr - text.data()) + (last ? 0 : 1));
    }
    Isometry3d T_unit_camera = Isometry3d::Identity();
    T_unit_camera.linear() = RotationFromRpy({n[3], n[4], n[5]}).toRotationMatrix();
    T_unit_camera.translation() = Vector3d(n[0], n[1], n[2]);
    return T_unit_camera;
}

}  // namespace hitchview::calib
