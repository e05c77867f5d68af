#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "algo/camera_model.hpp"
#include "algo/unit.hpp"
#include "calib/verdict.hpp"

namespace hitchview::calib {

/// Letters, digits and _, at least one.
bool IsName(std::string_view name);

/// One camera as its file describes it, number for number: reading and writing change no bit.
struct CalibratedCamera {
    algo::Unit unit = algo::Unit::kTractor;
    algo::CameraModel model{};
    /// Of T_unit_camera; its length is 1 within 1e-6.
    Eigen::Quaterniond q_unit_camera = Eigen::Quaterniond::Identity();
    /// Centre of projection in the unit frame (origin in the hitch point, x forward, y left, z up).
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();

    [[nodiscard]] algo::CameraGeometry Geometry() const;
    static CalibratedCamera From(algo::Unit unit, const algo::CameraGeometry& geometry);
};

/// Lenses and places of all cameras of one vehicle.
struct RigCalibration {
    std::string vehicle{};
    Verdict verdict = Verdict::kUnchecked;
    std::string written_by{};                           ///< command, build and date
    std::map<std::string, CalibratedCamera> cameras{};  ///< by name

    /// First 12 hexadecimal digits of the SHA-256 of vehicle and cameras in canonical form: equal
    /// for files that differ in comments, order of cameras, layout or spelling of numbers only.
    /// Verdict and provenance have no part in it.
    [[nodiscard]] std::string id() const;
};

/// A calibration, or what is wrong with its file: one line `file:line: key is VALUE, must be ...`
/// for each mistake.
struct LoadedCalibration {
    std::optional<RigCalibration> calibration{};
    std::string error{};  ///< empty when there is a calibration
};

/// Rotation of a camera whose body (x along the optical axis, y left, z up in the image) is turned
/// from the unit frame by Rz(yaw) Ry(pitch) Rx(roll), degrees. (0, 0, 0) looks forward, yaw 90
/// looks left, positive pitch looks down.
Eigen::Quaterniond RotationFromRpy(const Eigen::Vector3d& rpy_deg);

/// Strict: docs/conventions.md describes the format. A file that carries an `id` must match it.
/// Throws nothing.
LoadedCalibration LoadCalibration(const std::filesystem::path& file);
/// The same of a file's content. `name`: what complaints call the file.
LoadedCalibration ParseCalibration(const std::string& text, const std::string& name);

/// The file's text, in canonical form.
std::string ToYaml(const RigCalibration& calibration);

/// Replaces `file` in one step: a reader sees the old or the new content, whole. What
/// LoadCalibration would refuse is not written.
/// Empty on success, otherwise what went wrong. Throws nothing.
std::string SaveCalibration(const RigCalibration& calibration, const std::filesystem::path& file);

}  // namespace hitchview::calib
