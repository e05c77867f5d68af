#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "algo/camera_model.hpp"
#include "calib/rig_calibration.hpp"

/// Lenses and places in the files of other programs: docs/calibration-formats.md tells what each
/// carries. Nothing here throws.
namespace hitchview::calib {

enum class Format { kOpenCv, kRos, kKalibr, kMrcal };

/// One camera of such a file.
struct ForeignCamera {
    std::string name{};  ///< letters, digits and _
    algo::CameraModel model{};
    /// Where it stands in the file's frame of reference; empty where the file does not say.
    std::optional<Eigen::Isometry3d> T_reference_camera{};
};

/// The cameras of a file, or what is wrong with it: one line `file:line: key is VALUE, must be ...`
/// for each mistake. At least one camera if there is no error.
struct ForeignCameras {
    std::vector<ForeignCamera> cameras{};
    /// The frame of reference is the first camera's, not the unit's.
    bool from_first_camera = false;
    std::string error{};
};

/// What a file may leave open; where it does not, both must agree.
struct ImportHints {
    std::optional<algo::CameraModel::Kind> kind{};
    std::optional<std::array<int, 2>> size_px{};
};

/// At most 16 MiB, at most 1 MiB without what mrcal adds of its solution. Keys that tell nothing of
/// lens and place are passed over.
ForeignCameras ImportCameras(Format format, const std::filesystem::path& file,
                             const ImportHints& hints);
/// The same of a file's content. `file`: what complaints call it, and cameras without a name.
ForeignCameras ParseCameras(Format format, const std::string& text,
                            const std::filesystem::path& file, const ImportHints& hints);

/// A file to be written.
struct ForeignFile {
    std::string name{};
    std::string text{};
};

/// Files, or why the format cannot hold what is to be exported.
struct ExportedFiles {
    std::vector<ForeignFile> files{};
    std::string error{};
};

/// One file with one lens; its name is `name` and the format's extension.
ExportedFiles ExportLens(Format format, const std::string& name, const algo::CameraModel& model);

/// A file for each camera, named after it; of kalibr one for each unit.
ExportedFiles ExportRig(Format format, const RigCalibration& calibration);

}  // namespace hitchview::calib
