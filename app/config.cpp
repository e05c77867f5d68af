#include "app/config.hpp"

#include <array>
#include <cmath>

#include "app/config_sections.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::app {
namespace {

using calib::Choice;
using calib::Range;
using calib::YamlMap;
using calib::YamlValue;
using Projection = CanvasConfig::Projection;

constexpr std::array kProjections{Choice<Projection>{"plane", Projection::kPlane},
                                  Choice<Projection>{"cylinder", Projection::kCylinder}};
CanvasConfig ReadCanvas(const YamlValue& value) {
    constexpr Range<int> kWidth{64, 8192, true};
    constexpr Range<int> kHeight{64, 4096, true};
    CanvasConfig canvas;
    YamlMap map = value.Map();
    map["projection"].Read(kProjections, canvas.projection);
    const YamlValue horizon = map["horizon"];
    const YamlValue radius = map["radius_m"];
    const YamlValue viewpoint = map["viewpoint_m"];
    const YamlValue ground = map["ground_m"];
    if (canvas.projection == Projection::kPlane) {
        ReadSize(map.Required("size_px"), kWidth, kHeight, canvas.size_px);
        horizon.Refuse("absent with projection plane");
        radius.Refuse("absent with projection plane");
        viewpoint.Refuse("absent with projection plane");
        ground.Refuse("absent with projection plane");
    } else {
        canvas.size_px = {2048, 360};
        ReadSize(map["size_px"], kWidth, kHeight, canvas.size_px);
        horizon.Read({0, 1}, canvas.horizon);
        radius.Read({1, 1000}, canvas.radius_m);
        viewpoint.Read({0.5, 10}, canvas.viewpoint_m);
        ground.Read({-3, 0}, canvas.ground_m);
    }
    map.Finish();
    return canvas;
}

UnitConfig ReadUnit(const YamlValue& value, Projection projection, ConfigContext& context) {
    UnitConfig unit;
    YamlMap map = value.Map();
    const YamlValue cameras = value.given() ? map.Required("cameras") : map["cameras"];
    for (const YamlValue& camera : cameras.List({1, kMaxCameras})) {
        unit.cameras.push_back(ReadCamera(camera, context));
    }
    if (projection == Projection::kPlane && unit.cameras.size() > 1) {
        cameras.Refuse("a list of 1 with projection plane");
    }
    map.Finish();
    return unit;
}

algo::PerUnit<UnitConfig> ReadUnits(const YamlValue& value, Projection projection,
                                    ConfigContext& context) {
    algo::PerUnit<UnitConfig> units;
    YamlMap map = value.Map();
    const YamlValue tractor = map.Required("tractor");
    const YamlValue trailer = map["trailer"];
    units[algo::Unit::kTractor] = ReadUnit(tractor, projection, context);
    units[algo::Unit::kTrailer] = ReadUnit(trailer, projection, context);
    if (context.camera_names.size() > kMaxCameras) {
        value.Refuse("units with at most 8 cameras in total");
    }
    if (context.live_cameras > 0 && context.recorded_cameras > 0)
        value.Refuse("units whose cameras are all live (v4l2, libcamera), or none");
    map.Finish();
    return units;
}

std::optional<Placement> ReadPlacement(const YamlValue& value, const RigConfig& config) {
    if (!value.given()) return std::nullopt;
    if (config.canvas.projection != Projection::kPlane) {
        value.Refuse("absent with projection cylinder");
    }
    Placement placement;
    YamlMap map = value.Map();
    for (const algo::Unit unit : algo::kUnits) {
        const char* key = algo::ToString(unit);
        std::array<int, 2> corner{};
        (config.HasUnit(unit) ? map.Required(key) : map[key]).Read(Range<int>{-8192, 8192}, corner);
        placement[unit] = {corner[0], corner[1]};
    }
    map.Finish();
    return placement;
}

void ReadCalibrationPath(YamlMap& root, const ConfigContext& context, RigConfig& config) {
    if (config.canvas.projection == Projection::kPlane) {
        root["calibration"].Refuse("absent with canvas.projection plane");
    } else {
        ReadPath(root.Required("calibration"), context, config.calibration);
    }
}

std::optional<std::chrono::nanoseconds> ReadPeriod(const YamlValue& value) {
    if (!value.given()) return std::nullopt;
    double period_ms = 0;
    value.Read({1, 1000}, period_ms);
    return std::chrono::nanoseconds(std::llround(period_ms * 1e6));
}

std::optional<std::chrono::nanoseconds> ReadSetTolerance(const YamlValue& value,
                                                         const RigConfig& config,
                                                         const ConfigContext& context) {
    if (!value.given()) return std::nullopt;
    if (!context.IsLive())
        value.Refuse("absent unless the cameras are live (v4l2, libcamera, simulation.live)");
    const auto period = config.period.value_or(std::chrono::nanoseconds(kDefaultPeriod));
    double tolerance_ms = 1;
    // Divided, not multiplied by 1e-6: so a tolerance written like the period is within it.
    value.Read({1, static_cast<double>(period.count()) / 1e6}, tolerance_ms);
    return std::chrono::nanoseconds(std::llround(tolerance_ms * 1e6));
}

void CheckCanBeside(const YamlValue& can, CanConfig::Source source, const ConfigContext& context) {
    using Source = CanConfig::Source;
    if (context.live_cameras > 0 && source != Source::kSocketCan)
        can.Refuse("a map with the source {socketcan: NAME} beside live cameras");
    if (context.live_simulation && source == Source::kCandump)
        can.Refuse(
            "a map with the source {simulated: true} or {socketcan: NAME} with "
            "simulation.live");
}

RigConfig ReadRig(YamlMap& root, ConfigContext& context) {
    RigConfig config;
    int schema = 1;
    root.Required("schema").Read(Range<int>{1, 1}, schema);
    config.canvas = ReadCanvas(root["canvas"]);
    ReadCalibrationPath(root, context, config);
    config.units = ReadUnits(root.Required("units"), config.canvas.projection, context);
    config.simulation = ReadSimulation(root["simulation"], context);
    config.stabilization = ReadStabilization(root["stabilization"]);
    config.stitching = ReadStitching(root["stitching"]);
    config.placement = ReadPlacement(root["placement"], config);
    ReadThreads(root["threads"], config);
    config.real_time = ReadRealTime(root["real_time"]);
    config.period = ReadPeriod(root["period_ms"]);
    config.set_tolerance = ReadSetTolerance(root["set_tolerance_ms"], config, context);
    const YamlValue can = root["can"];
    config.can = ReadCan(can, context);
    if (config.can) CheckCanBeside(can, config.can->source, context);
    config.publish =
        ReadPublish(root["publish"], config.canvas.projection == Projection::kCylinder);
    config.record = ReadRecord(root["record"], context);
    root.Finish();
    return config;
}

/// Empty when the calibration has `camera` on `unit`.
std::string CalibrationProblem(const calib::RigCalibration& calibration, const std::string& camera,
                               algo::Unit unit) {
    const auto found = calibration.cameras.find(camera);
    if (found == calibration.cameras.end()) {
        return "cameras." + camera + " is missing, must be there for this rig";
    }
    if (found->second.unit == unit) return "";
    return "cameras." + camera + ".unit is " + algo::ToString(found->second.unit) + ", must be " +
           algo::ToString(unit) + " for this rig";
}

hal::Checked<RigConfig> ReadWhole(YamlMap root, const calib::YamlComplaints& complaints,
                                  ConfigContext context) {
    RigConfig config = ReadRig(root, context);
    if (!complaints.empty()) return complaints.Text();
    return config;
}

}  // namespace

hal::Checked<RigConfig> LoadRigConfig(const std::filesystem::path& file) {
    calib::YamlComplaints complaints(file.string());
    auto config = ReadWhole(calib::LoadYaml(file, complaints), complaints,
                            ConfigContext{.folder = file.parent_path()});
    if (config) config->file = file;
    return config;
}

hal::Checked<RigConfig> ParseRigConfig(const NamedText& rig, const std::filesystem::path& folder) {
    calib::YamlComplaints complaints(rig.name);
    auto config = ReadWhole(calib::ParseYaml(rig.text, complaints), complaints,
                            ConfigContext{.folder = folder, .recorded = true});
    if (config) config->file = rig.name;
    return config;
}

hal::Checked<calib::RigCalibration> LoadCalibrationFor(const RigConfig& config) {
    const auto& text = config.calibration_text;
    calib::LoadedCalibration loaded = text ? calib::ParseCalibration(text->text, text->name)
                                           : calib::LoadCalibration(config.calibration);
    if (!loaded.calibration) return std::move(loaded.error);
    for (const algo::Unit unit : algo::kUnits) {
        for (const CameraConfig& camera : config.units[unit].cameras) {
            const std::string problem = CalibrationProblem(*loaded.calibration, camera.name, unit);
            if (!problem.empty())
                return (text ? text->name : config.calibration.string()) + ": " + problem;
        }
    }
    return std::move(*loaded.calibration);
}

}  // namespace hitchview::app
