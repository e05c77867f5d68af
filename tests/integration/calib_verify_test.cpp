#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/truth_calibration.hpp"
#include "calib/rig_calibration.hpp"
#include "tests/support/calib_program.hpp"
#include "tests/support/simulated_pictures.hpp"
#include "tests/support/temporary_folder.hpp"

// `hitchview-calib verify` on pictures of a drive of the simulated rig.
namespace hitchview {
namespace {

using nlohmann::json;
using tests::CalibOutcome;

constexpr double kDegree = std::numbers::pi / 180;

class CalibVerifyTest : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        today_ = new tests::TemporaryFolder;
        const auto rig = tests::Rig({.frames = 60, .profile = drivers::DriveProfile::kStraight});
        for (int camera = 0; camera < drivers::SimulatedRig::kCameras; ++camera) {
            const std::string name(rig->camera(camera).name);
            std::filesystem::create_directories(*today_ / name);
            auto nv12 = tests::Rendered(*rig, camera, 50);
            const cv::Mat grey(720, 1280, CV_8U, nv12.data());
            cv::imwrite(*today_ / name + "/50.png", grey);
        }
    }
    static void TearDownTestSuite() { delete today_; }

    /// Turns a camera of the calibration about its unit's axis.
    void Turn(const std::string& camera, double degrees, const Eigen::Vector3d& axis) {
        Eigen::Quaterniond& q = rig_.cameras.at(camera).q_unit_camera;
        q = (Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kDegree, axis)) * q).normalized();
    }

    CalibOutcome Verify() {
        EXPECT_EQ(calib::SaveCalibration(rig_, folder_ / "rig.calib.yaml"), "");
        return tests::RunCalib("verify --calibration " + (folder_ / "rig.calib.yaml") +
                               " --pictures " + today_->path() + " --json " +
                               (folder_ / "verify.json") + " --view " + (folder_ / "view"));
    }
    [[nodiscard]] json Figures() const {
        return json::parse(std::ifstream(folder_ / "verify.json"));
    }

    static tests::TemporaryFolder* today_;
    tests::TemporaryFolder folder_;
    calib::RigCalibration rig_ = app::CalibrationOf(drivers::SimulatedRigGeometry(1280, 720));
};

tests::TemporaryFolder* CalibVerifyTest::today_ = nullptr;

TEST_F(CalibVerifyTest, ATrueCalibrationHolds) {
    const CalibOutcome outcome = Verify();
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    const json figures = Figures();
    EXPECT_EQ(figures["verdict"], "pass");
    EXPECT_EQ(figures["calibration_id"], rig_.id());
    int pairs = 0;
    for (const json& check : figures["checks"]) {
        if (check["name"].get<std::string>().find("misalignment") == std::string::npos) continue;
        ++pairs;
        EXPECT_LT(check["figure"], 1.0) << check;
    }
    EXPECT_GE(pairs, 6);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "view/trailer.png"));
}

TEST_F(CalibVerifyTest, ACameraThatWasTurnedIsNamed) {
    Turn("left_rear", 1.0, Eigen::Vector3d::UnitZ());
    const CalibOutcome outcome = Verify();
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_TRUE(outcome.Says("left_rear moved (turned by some")) << outcome.text;
}

TEST_F(CalibVerifyTest, SwappedPicturesAreNotGood) {
    std::swap(rig_.cameras.at("left"), rig_.cameras.at("left_rear"));
    const CalibOutcome outcome = Verify();
    EXPECT_EQ(outcome.code, 1) << outcome.text;
}

TEST_F(CalibVerifyTest, ADirectionWithoutACameraIsAHole) {
    for (const char* camera : {"left_rear", "rear", "right_rear"}) rig_.cameras.erase(camera);
    const CalibOutcome outcome = Verify();
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_TRUE(outcome.Says("no camera sees there")) << outcome.text;
}

TEST_F(CalibVerifyTest, ACameraWithoutPicturesIsToldByName) {
    rig_.cameras["extra"] = rig_.cameras.at("rear");
    const CalibOutcome outcome = Verify();
    EXPECT_EQ(outcome.code, 2) << outcome.text;
    EXPECT_TRUE(outcome.Says("camera extra: no file is named")) << outcome.text;
}

}  // namespace
}  // namespace hitchview
