#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "calib/rig_calibration.hpp"
#include "tests/support/simulated_rig_files.hpp"

namespace hitchview::tests {

/// One instant of six cameras round a car, told as a rig: three look forward (the tractor) and
/// three back (the trailer). Neighbours overlap by 6 to 12 degrees. Within a unit the calibration
/// says how cameras join, and so it does between the units until the pictures tell more.
class SixCameraRing {
 public:
    static constexpr int kFrames = 12;
    struct Camera {
        const char* name;  ///< in the rig file and, in capitals after CAM_, in the recording
        algo::Unit unit;
    };
    /// Anticlockwise, from the right.
    static constexpr std::array<Camera, 6> kCameras{{{"front_right", algo::Unit::kTractor},
                                                     {"front", algo::Unit::kTractor},
                                                     {"front_left", algo::Unit::kTractor},
                                                     {"back_left", algo::Unit::kTrailer},
                                                     {"back", algo::Unit::kTrailer},
                                                     {"back_right", algo::Unit::kTrailer}}};

    /// `data`: folder of pictures and calibration.json.
    explicit SixCameraRing(const std::filesystem::path& data) {
        std::ifstream file(data / "calibration.json");
        const nlohmann::json cameras = nlohmann::json::parse(file).at("cameras");
        calib::RigCalibration calibration;
        calibration.vehicle = "six cameras round a car";
        calibration.written_by = "a test, from the recording's own calibration";
        for (const Camera& camera : kCameras) {
            const nlohmann::json& entry = cameras.at("CAM_" + Capitals(camera.name));
            Repeat(data / entry.at("file").get<std::string>(), camera.name);
            calibration.cameras[camera.name] =
                calib::CalibratedCamera::From(camera.unit, Geometry(entry));
        }
        const std::string refused = SaveCalibration(calibration, folder_ / "ring.calib.yaml");
        EXPECT_EQ(refused, "");
    }

    [[nodiscard]] std::string Rig() const {
        std::string text =
            "schema: 1\ncalibration: ring.calib.yaml\ncanvas: {projection: cylinder, size_px: "
            "[4096, 480], horizon: 0.5, radius_m: 50, viewpoint_m: 1.1, ground_m: -0.4}\nunits:\n";
        for (const algo::Unit unit : algo::kUnits) {
            text += "  " + std::string(ToString(unit)) + ":\n    cameras:\n";
            for (const Camera& camera : kCameras) {
                if (camera.unit != unit) continue;
                const std::string name = camera.name;
                text += "      - {name: " + name + ", source: {replay: " + name + "}}\n";
            }
        }
        return folder_.Write("rig.yaml", text);
    }
    /// Of one camera's picture.
    [[nodiscard]] std::string Picture(const std::string& name) const {
        return folder_ / (name + "/0.jpg");
    }

 private:
    static std::string Capitals(std::string name) {
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        return name;
    }

    /// A recording of kFrames times the same picture.
    void Repeat(const std::filesystem::path& picture, const std::string& name) const {
        std::filesystem::create_directory(folder_ / name);
        for (int i = 0; i < kFrames; ++i) {
            const std::string link = name + "/" + std::to_string(i) + ".jpg";
            std::filesystem::create_symlink(std::filesystem::absolute(picture), folder_ / link);
        }
    }

    /// The car's frame has its origin on the road below the rear axle; the unit frame is 1 m
    /// before it and 0.4 m above the road, in the middle of the cameras.
    static algo::CameraGeometry Geometry(const nlohmann::json& entry) {
        algo::CameraGeometry geometry;
        const auto& K = entry.at("cam2img");
        geometry.model = {.kind = algo::CameraModel::Kind::kPinholeRadtan,
                          .width_px = 1600,
                          .height_px = 900,
                          .fx_px = K[0][0],
                          .fy_px = K[1][1],
                          .cx_px = K[0][2],
                          .cy_px = K[1][2],
                          .max_theta_rad = 1.0};
        Eigen::Matrix4d T;
        for (int row = 0; row < 4; ++row) {
            for (int col = 0; col < 4; ++col)
                T(row, col) = entry.at(
                    "cam2ego")[static_cast<std::size_t>(row)][static_cast<std::size_t>(col)];
        }
        T.topRightCorner<3, 1>() -= Eigen::Vector3d(1.0, 0, 0.4);
        geometry.T_unit_camera = Eigen::Isometry3d(T);
        return geometry;
    }

    TemporaryFolder folder_;
};

}  // namespace hitchview::tests
