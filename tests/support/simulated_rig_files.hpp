#pragma once

#include <gtest/gtest.h>

#include <string>

#include "calib/rig_calibration.hpp"
#include "drivers/simulated_rig.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::tests {

/// `rig.calib.yaml` of the simulated rig, for cameras of this size.
inline void WriteSimulatedCalibration(const TemporaryFolder& folder, int width_px, int height_px) {
    calib::RigCalibration calibration{.vehicle = "simulated", .written_by = "test"};
    for (const auto& camera : drivers::SimulatedRigGeometry(width_px, height_px)) {
        calibration.cameras[std::string(camera.name)] =
            calib::CalibratedCamera::From(camera.unit, camera.geometry);
    }
    EXPECT_EQ(calib::SaveCalibration(calibration, folder / "rig.calib.yaml"), "");
}

/// The key `units` with all eight cameras. `source_of(name)` is what stands behind `source:`.
template <typename SourceOf>
std::string SimulatedUnits(SourceOf&& source_of) {
    std::string text = "units:\n";
    for (const algo::Unit unit : algo::kUnits) {
        text += std::string("  ") + ToString(unit) + ":\n    cameras:\n";
        for (const auto& camera : drivers::SimulatedRigGeometry(320, 180)) {
            if (camera.unit != unit) continue;
            const std::string name(camera.name);
            text += "      - {name: " + name + ", source: " + source_of(name) + "}\n";
        }
    }
    return text;
}

/// The hitch angle as the simulated bus sends it.
inline constexpr const char* kSimulatedHitchAngle =
    "  hitch_angle: {id: 1111, start_bit: 23, length_bits: 12, byte_order: motorola, factor_deg: "
    "0.1, "
    "offset_deg: -90}\n";

}  // namespace hitchview::tests
