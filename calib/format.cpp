#include "calib/format.hpp"

#include "calib/format_document.hpp"
#include "calib/format_kalibr.hpp"
#include "calib/format_mrcal.hpp"
#include "calib/format_opencv.hpp"
#include "calib/format_ros.hpp"

namespace hitchview::calib {
namespace {

ForeignCameras Read(Format format, YamlMap& root, const ImportHints& hints,
                    const std::string& name) {
    switch (format) {
        case Format::kOpenCv:
            return {.cameras = ReadOpenCv(root, hints, name)};
        case Format::kRos:
            return {.cameras = ReadRos(root, hints, name)};
        case Format::kMrcal:
            return {.cameras = ReadMrcal(root, hints, name)};
        case Format::kKalibr:
            break;
    }
    return ReadKalibr(root, hints);
}

ForeignCameras ReadWhole(Format format, YamlMap& root, const YamlComplaints& complaints,
                         const std::filesystem::path& file, const ImportHints& hints) {
    if (!complaints.empty()) return {.error = complaints.Text()};
    ForeignCameras read = Read(format, root, hints, AsName(file.stem().string(), "camera"));
    if (!complaints.empty()) return {.error = complaints.Text()};
    return read;
}

const char* Extension(Format format) {
    return format == Format::kMrcal ? ".cameramodel" : ".yaml";
}

ExportedFiles OneCamera(Format format, const ForeignCamera& camera) {
    const std::string file = camera.name + Extension(format);
    switch (format) {
        case Format::kOpenCv:
            return {{{file, OpenCvText(camera.model)}}, ""};
        case Format::kRos:
            return {{{file, RosText(camera.name, camera.model)}}, ""};
        case Format::kMrcal:
            return {{{file, MrcalText(camera)}}, MrcalRefusal(camera)};
        case Format::kKalibr:
            break;
    }
    const CamchainText chain = KalibrText({camera});
    return {{{file, chain.text}}, chain.error};
}

void Add(ExportedFiles one, ExportedFiles& all) {
    if (!one.error.empty()) all.error += (all.error.empty() ? "" : "\n") + one.error;
    for (ForeignFile& file : one.files) all.files.push_back(std::move(file));
}

ExportedFiles Chains(const std::map<algo::Unit, std::vector<ForeignCamera>>& units) {
    ExportedFiles all;
    for (const auto& [unit, cameras] : units) {
        const CamchainText chain = KalibrText(cameras);
        Add({{{std::string(algo::ToString(unit)) + ".yaml", chain.text}}, chain.error}, all);
    }
    return all;
}

}  // namespace

ForeignCameras ImportCameras(Format format, const std::filesystem::path& file,
                             const ImportHints& hints) {
    YamlComplaints complaints(file.string());
    YamlMap root = LoadForeign(format, file, complaints);
    return ReadWhole(format, root, complaints, file, hints);
}

ForeignCameras ParseCameras(Format format, const std::string& text,
                            const std::filesystem::path& file, const ImportHints& hints) {
    YamlComplaints complaints(file.string());
    YamlMap root = ParseForeign(format, text, complaints);
    return ReadWhole(format, root, complaints, file, hints);
}

ExportedFiles ExportLens(Format format, const std::string& name, const algo::CameraModel& model) {
    return OneCamera(format, {AsName(name, "camera"), model, std::nullopt});
}

ExportedFiles ExportRig(Format format, const RigCalibration& calibration) {
    std::map<algo::Unit, std::vector<ForeignCamera>> units;
    ExportedFiles all;
    for (const auto& [name, camera] : calibration.cameras) {
        const ForeignCamera foreign{name, camera.model, camera.Geometry().T_unit_camera};
        units[camera.unit].push_back(foreign);
        if (format != Format::kKalibr) Add(OneCamera(format, foreign), all);
    }
    return format == Format::kKalibr ? Chains(units) : all;
}

}  // namespace hitchview::calib
