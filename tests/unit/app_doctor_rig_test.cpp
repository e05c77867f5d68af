#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/healthy_machine.hpp"

// The same of what the rig file says: cameras, CAN bus, calibration, and the file itself.
namespace hitchview::app {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class DoctorRigTest : public testing::Test {
 protected:
    void SetUp() override { ASSERT_THAT(machine_.Names(Finding::kBad), IsEmpty()); }
    void ExpectBad(const std::string& check, const std::string& what) {
        EXPECT_THAT(machine_.Names(Finding::kBad), ElementsAre(check));
        const Diagnosis diagnosis = machine_.Answer(check);
        EXPECT_THAT(diagnosis.what, HasSubstr(what));
        EXPECT_NE(diagnosis.remedy, "");
    }
    void ExpectAfter(const std::string& check, const std::string& root) {
        const Diagnosis diagnosis = machine_.Answer(check);
        EXPECT_EQ(diagnosis.finding, Finding::kUnknown) << check;
        EXPECT_THAT(diagnosis.what, StartsWith("after " + root));
        EXPECT_EQ(diagnosis.remedy, "");
    }
    /// As a service that cannot start without something.
    void FailService() {
        machine_.service["ActiveState"] = "activating";
        machine_.service["SubState"] = "auto-restart";
        machine_.service["Result"] = "exit-code";
        machine_.service["NRestarts"] = "7";
    }

    tests::HealthyMachine machine_;
};

TEST_F(DoctorRigTest, ARigFileThatSaysWhatMayNotBeSaid) {
    machine_.Replace("etc/hitchview/rig.yaml", "quota_mb: 100", "quota_mb: -1");
    FailService();
    ExpectBad("rig_file", "rig.yaml:5: record.quota_mb is -1");
    ExpectAfter("camera_formats", "rig_file");
    ExpectAfter("display_stream", "rig_file");
    ExpectAfter("service", "rig_file");
}

TEST_F(DoctorRigTest, ARigFileThatTheServiceMayNotRead) {
    chmod(machine_.Path("etc/hitchview/rig.yaml").c_str(), 0600);
    ExpectBad("rig_file", "user hitchview may not read");
}

TEST_F(DoctorRigTest, NoRigFileWhereTheServiceWaitsForOne) {
    machine_.Remove("etc/hitchview/rig.yaml");
    machine_.service["ActiveState"] = "inactive";
    ExpectBad("rig_file", "which the service waits for");
}

TEST_F(DoctorRigTest, NoRigFileWhereNobodyWaitsForOneIsNotJudged) {
    machine_.Remove("etc/hitchview/rig.yaml");
    machine_.service = {{"LoadState", "not-found"}};
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
    EXPECT_THAT(machine_.Names(Finding::kUnknown), Contains("camera_devices"));
    EXPECT_THAT(machine_.Names(Finding::kGood), Contains("lcm_delivery"));
}

TEST_F(DoctorRigTest, ACameraThatIsGone) {
    machine_.Remove("dev/hitchview/rear");
    FailService();
    ExpectBad("camera_devices", "rear");
    EXPECT_EQ(machine_.Answer("camera_formats").what,
              "7 cameras can give what the rig asks of them");
    ExpectAfter("service", "camera_devices");
}

TEST_F(DoctorRigTest, AllCamerasGone) {
    machine_.Remove("dev/hitchview");
    machine_.cameras.clear();
    ExpectBad("camera_devices", "nothing is there");
    ExpectAfter("camera_formats", "camera_devices");
    ExpectAfter("camera_access", "camera_devices");
}

TEST_F(DoctorRigTest, TwoNamesForOneCamera) {
    machine_.Remove("dev/hitchview/rear");
    std::filesystem::create_symlink("../video0", machine_.Path("dev/hitchview/rear"));
    ExpectBad("camera_devices", "has it");
}

TEST_F(DoctorRigTest, ACameraThatTheServiceMayNotOpen) {
    chmod(machine_.Path("dev/video3").c_str(), 0600);
    FailService();
    ExpectBad("camera_access", "user hitchview may not open");
    ExpectAfter("service", "camera_access");
}

TEST_F(DoctorRigTest, AUserOutsideTheGroupOfTheCameras) {
    machine_.user_groups.clear();
    chmod(machine_.Path("var/lib/hitchview/recordings").c_str(), 0777);
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty()) << "the service has the group itself";
    machine_.service["SupplementaryGroups"] = "";
    ExpectBad("camera_access", "may not open");
}

TEST_F(DoctorRigTest, ACameraWithoutTheFormatThatIsAskedFor) {
    machine_.cameras[2].pick.reset();
    machine_.cameras[2].no_pick = "wanted 1280x720 at 30 Hz as mjpeg, which it does not offer";
    ExpectBad("camera_formats", "as mjpeg, which it does not offer");
}

TEST_F(DoctorRigTest, ACameraThatIsAskedForAnotherSizeThanItHasAndIsCalibratedFor) {
    machine_.Replace("etc/hitchview/rig.yaml", "/dev/hitchview/rear",
                     "/dev/hitchview/rear, size_px: [1234, 720]");
    ExpectBad("calibration", "camera rear is asked for 1234x720, calibrated for 1280x720");
    machine_.cameras.back().no_pick = "wanted 1234x720";
    for (CameraDevice& device : machine_.cameras) device.no_pick = "wanted 1234x720";
    ExpectBad("camera_formats", "wanted 1234x720");
    ExpectAfter("calibration", "camera_formats");
}

TEST_F(DoctorRigTest, DriversThatGiveNoAnswer) {
    auto machine = machine_.Machine();
    machine.cameras = [](const auto&) {
        std::this_thread::sleep_for(std::chrono::seconds(3));
        return std::vector<CameraDevice>();
    };
    std::vector<std::string> bad;
    for (const DoctorAnswer& answer : RunChecks(AllChecks(ExamineMachine(machine, "")))) {
        if (answer.diagnosis.finding == Finding::kBad) bad.push_back(answer.name);
    }
    EXPECT_THAT(bad, ElementsAre("camera_devices"));
}

TEST_F(DoctorRigTest, ACanInterfaceThatIsGone) {
    machine_.can_exists = false;
    FailService();
    ExpectBad("can_interface", "there is no interface 'can0'");
    ExpectAfter("can_up", "can_interface");
    ExpectAfter("service", "can_interface");
}

TEST_F(DoctorRigTest, AnInterfaceThatIsNoBus) {
    machine_.can.is_can = false;
    ExpectBad("can_interface", "no CAN interface");
}

TEST_F(DoctorRigTest, ABusWithoutBitRate) {
    machine_.can = {.is_can = true, .has_bit_rate = true, .state = CanLinkFacts::State::kOffBus};
    ExpectBad("can_bit_rate", "has no bit rate");
    ExpectAfter("can_up", "can_bit_rate");
    ExpectAfter("can_bus_state", "can_bit_rate");
}

TEST_F(DoctorRigTest, ABusThatIsDown) {
    machine_.can.is_up = false;
    machine_.can.state = CanLinkFacts::State::kOffBus;
    ExpectBad("can_up", "can0 is down");
    ExpectAfter("can_bus_state", "can_up");
}

TEST_F(DoctorRigTest, AControllerThatLeftTheBus) {
    machine_.can.state = CanLinkFacts::State::kBusOff;
    ExpectBad("can_bus_state", "bus-off; it stays so");
    machine_.can.restart_ms = 100;
    ExpectBad("can_bus_state", "again after 100 ms");
}

TEST_F(DoctorRigTest, AVirtualBusNeedsNoBitRate) {
    machine_.can = {.is_can = true, .is_up = true};
    EXPECT_THAT(machine_.Names(Finding::kBad), IsEmpty());
    EXPECT_THAT(machine_.Names(Finding::kUnknown), Not(Contains("can_bit_rate")));
}

TEST_F(DoctorRigTest, ACalibrationThatIsNotThere) {
    machine_.Remove("etc/hitchview/rig.calib.yaml");
    FailService();
    ExpectBad("calibration", "rig.calib.yaml");
    ExpectAfter("service", "calibration");
}

TEST_F(DoctorRigTest, ACalibrationOfOtherCameras) {
    machine_.Replace("etc/hitchview/rig.yaml", "name: rear", "name: trailer_back");
    ExpectBad("calibration", "trailer_back");
}

TEST_F(DoctorRigTest, ACalibrationThatTheServiceMayNotRead) {
    chmod(machine_.Path("etc/hitchview/rig.calib.yaml").c_str(), 0600);
    ExpectBad("calibration", "user hitchview may not read");
}

TEST_F(DoctorRigTest, ACalibrationThatFailedItsOwnVerdict) {
    const auto file = machine_.Path("etc/hitchview/rig.calib.yaml");
    auto calibration = calib::LoadCalibration(file).calibration.value();
    EXPECT_THAT(machine_.Answer("calibration").what, HasSubstr(calibration.id()));
    calibration.verdict = calib::Verdict::kFail;
    ASSERT_EQ(SaveCalibration(calibration, file), "");
    chmod(file.c_str(), 0644);
    ExpectBad("calibration", "its own verdict is fail");
}

TEST_F(DoctorRigTest, AnotherRigFileIsJudgedInPlaceOfTheInstalledOne) {
    const auto other = machine_.Path("other.yaml");
    machine_.Write("other.yaml",
                   "schema: 1\ncanvas: {projection: plane, size_px: [640, 360]}\nunits: {tractor: "
                   "{cameras: [{name: left, source: {v4l2: /dev/hitchview/nothing}}]}}\n");
    std::map<std::string, Finding> findings;
    for (const DoctorAnswer& answer : machine_.Answers(other))
        findings[answer.name] = answer.diagnosis.finding;
    EXPECT_EQ(findings["camera_devices"], Finding::kBad);
    EXPECT_EQ(findings["display_stream"], Finding::kUnknown);
}

}  // namespace
}  // namespace hitchview::app
