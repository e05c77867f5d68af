#include <gtest/gtest.h>

#include "app/calibration_mismatch.hpp"

namespace hitchview::app {
namespace {

using hal::EventCode;
using std::chrono::seconds;

RigConfig Rig() {
    RigConfig config;
    config.units[algo::Unit::kTractor].cameras = {{.name = "front"}};
    config.units[algo::Unit::kTrailer].cameras = {{.name = "rear"}};
    return config;
}

std::optional<calib::RigCalibration> Calibration(std::vector<std::string> cameras) {
    calib::RigCalibration calibration;
    for (const std::string& name : cameras) calibration.cameras[name];
    return calibration;
}

TEST(CalibrationMismatchTest, ACalibrationThatFitsIsNoEvent) {
    EXPECT_TRUE(CalibrationMismatches(Rig(), Calibration({"front", "rear"}), seconds(1)).empty());
    EXPECT_TRUE(CalibrationMismatches(Rig(), std::nullopt, seconds(1)).empty());
}

TEST(CalibrationMismatchTest, CamerasThatTheRigLacksAreNamed) {
    const auto events =
        CalibrationMismatches(Rig(), Calibration({"front", "left", "rear", "right"}), seconds(3));
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(events[0].code, EventCode::kCalibrationMismatch);
    EXPECT_EQ(events[0].when, seconds(3));
    EXPECT_EQ(events[0].subject.view(), "left");
    EXPECT_EQ(events[1].subject.view(), "right");
}

TEST(CalibrationMismatchTest, ACalibrationThatFailedIsTold) {
    auto calibration = Calibration({"front", "rear"});
    calibration->verdict = calib::Verdict::kFail;
    const auto events = CalibrationMismatches(Rig(), calibration, seconds(1));
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].text.view(), "the calibration's own verdict is fail");
}

}  // namespace
}  // namespace hitchview::app
