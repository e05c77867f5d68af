#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "app/config.hpp"
#include "calib/yaml_map.hpp"

/// Readers of the sections of a rig file, for LoadRigConfig alone. Each reads what is given over
/// the defaults and leaves its complaints with the file's.
namespace hitchview::app {

/// What the sections of one file share.
struct ConfigContext {
    std::filesystem::path folder{};
    bool recorded = false;  ///< a recording's rig file: other files may not be there
    std::set<std::string> camera_names{};
    std::set<std::string> devices{};
    int live_cameras = 0;      ///< that are devices
    int recorded_cameras = 0;  ///< and simulated
    int simulated_cameras = 0;
    bool live_simulation = false;

    [[nodiscard]] bool IsLive() const { return live_cameras > 0 || live_simulation; }
};

void ReadPath(const calib::YamlValue& value, const ConfigContext& context,
              std::filesystem::path& out);
void ReadSize(const calib::YamlValue& value, const calib::Range<int>& width,
              const calib::Range<int>& height, Size& out);
/// Of a key that is a choice by being there: if given, it must be `true`.
void ReadTrue(const calib::YamlValue& value);

/// In config_camera.cpp.
CameraConfig ReadCamera(const calib::YamlValue& value, ConfigContext& context);
SimulationConfig ReadSimulation(const calib::YamlValue& value, ConfigContext& context);
StabilizationConfig ReadStabilization(const calib::YamlValue& value);
/// Workers and their schedule.
void ReadThreads(const calib::YamlValue& value, RigConfig& config);
RealTimeConfig ReadRealTime(const calib::YamlValue& value);
StitchingConfig ReadStitching(const calib::YamlValue& value);
/// In config_can.cpp. Reads the DBC file too, if there is one.
std::optional<CanConfig> ReadCan(const calib::YamlValue& value, const ConfigContext& context);
/// In config_publish.cpp.
PublishConfig ReadPublish(const calib::YamlValue& value, bool ring);
/// In config_record.cpp.
RecordConfig ReadRecord(const calib::YamlValue& value, const ConfigContext& context);

}  // namespace hitchview::app
