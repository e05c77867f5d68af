#include "app/simulated_board.hpp"

#include <fstream>
#include <sstream>

#include "app/truth_calibration.hpp"
#include "drivers/simulated_can_bus.hpp"
#include "drivers/simulated_scenario.hpp"

namespace hitchview::app {
namespace {

using Table = drivers::SimulatedRigGeometryTable;

void WriteUnits(const Table& cameras, std::ostream& yaml) {
    yaml << "units:\n";
    for (const algo::Unit unit : algo::kUnits) {
        yaml << "  " << ToString(unit) << ":\n    cameras:\n";
        for (const auto& camera : cameras)
            if (camera.unit == unit)
                yaml << "      - {name: " << camera.name << ", source: {simulated: true}}\n";
    }
}

std::string Length(const SimulatedBoardOptions& options) {
    std::string keys = options.live ? "live: true" : "frames: " + std::to_string(options.frames);
    if (options.loop_frames > 0) keys += ", loop_frames: " + std::to_string(options.loop_frames);
    return keys;
}

std::string RigYaml(const SimulatedBoardOptions& options, const Table& cameras) {
    std::ostringstream yaml;
    yaml << "# The simulated vehicle.\n"
         << "schema: 1\ncanvas: {projection: cylinder}\ncalibration: rig.calib.yaml\n";
    WriteUnits(cameras, yaml);
    yaml << "simulation: {scenario: " << options.scenario << ", " << Length(options)
         << ", camera_size_px: [" << options.camera_width_px << ", "
         << options.camera_width_px * 9 / 16 << "]}\n"
         << "can:\n  source: {simulated: true}\n  hitch_angle: {id: "
         << drivers::SimulatedCanBus::kHitchAngleId
         << ", start_bit: 23, length_bits: 12, byte_order: motorola, factor_deg: 0.1,\n"
         << "                offset_deg: -90, min_deg: -90, max_deg: 90}\n";
    return yaml.str();
}

}  // namespace

hal::Checked<std::filesystem::path> WriteSimulatedBoard(const SimulatedBoardOptions& options,
                                                        const std::filesystem::path& folder) {
    std::error_code refused;
    std::filesystem::create_directories(folder, refused);
    if (refused) return folder.string() + ": cannot be made: " + refused.message();
    const Table cameras =
        drivers::SimulatedRigGeometry(options.camera_width_px, options.camera_width_px * 9 / 16);
    const drivers::Scenario* scenario = drivers::FindScenario(options.scenario);
    const Table calibrated =
        scenario ? drivers::Miscalibrated(cameras, scenario->options.calibration) : cameras;
    const std::string saved =
        calib::SaveCalibration(CalibrationOf(calibrated), folder / "rig.calib.yaml");
    if (!saved.empty()) return saved;
    const std::filesystem::path rig = folder / "rig.yaml";
    std::ofstream out(rig);
    out << RigYaml(options, cameras);
    out.close();
    if (!out) return rig.string() + ": cannot be written";
    return rig;
}

}  // namespace hitchview::app
