#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/calib_hitch_verb.hpp"
#include "calib/rig_calibration.hpp"
#include "drivers/simulated_rig.hpp"
#include "tests/support/board_scene.hpp"
#include "tests/support/log_messages.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;

/// A drive of a minute whose sensor counts 5 % too little and is 2 degrees off.
std::string WriteLog(const tests::TemporaryFolder& folder, double most_rad, const char* rig_yaml) {
    const std::string file = folder / "drive.lcm";
    tests::MessageLog log(file);
    log.Rig({"front"}, {"CAM_FRONT"}, 33, {.rig = rig_yaml});
    for (std::uint32_t i = 0; i < 600; ++i) {
        const std::int64_t at_ns = 1'000'000'000 + std::int64_t{100'000'000} * i;
        const double swing = std::sin(0.01 * i);
        const double articulation_rad = most_rad * swing * swing * swing;
        log.HitchAngle(at_ns, i, hal::HitchAngleQuality::kValid,
                       (articulation_rad - 2 * kDegree) / 1.05);
        log.Status(at_ns + 1000, i, articulation_rad);
    }
    return file;
}

nlohmann::json Read(const std::string& file) {
    return nlohmann::json::parse(std::ifstream(file));
}

TEST(CalibHitchLogTest, PrintsTheLinesForTheRigFile) {
    const tests::TemporaryFolder folder;
    const std::string log = WriteLog(
        folder, 0.6, "schema: 1\ncan: {hitch_angle: {factor_deg: 0.1, offset_deg: -250}}\n");
    testing::internal::CaptureStdout();
    EXPECT_EQ(HitchVerb({.log = {log}, .json = folder / "figures.json"}), 0);
    EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("    factor_deg: 0.10"));

    const auto figures = Read(folder / "figures.json");
    EXPECT_NEAR(figures["factor"].get<double>(), 1.05, 0.002);
    EXPECT_NEAR(figures["offset_deg"].get<double>(), 2, 0.05);
    EXPECT_NEAR(figures["signal_factor_deg"].get<double>(), 0.105, 0.0002);
    EXPECT_NEAR(figures["signal_offset_deg"].get<double>(), -250 * 1.05 + 2, 0.5);
}

TEST(CalibHitchLogTest, SaysWhatTheDriveLacks) {
    const tests::TemporaryFolder folder;
    const std::string log = WriteLog(folder, 0.06, "schema: 1\n");
    testing::internal::CaptureStdout();
    EXPECT_EQ(HitchVerb({.log = {log}}), 1);
    const std::string told = testing::internal::GetCapturedStdout();
    EXPECT_THAT(told, HasSubstr("the drive has no turn"));
    EXPECT_THAT(told, HasSubstr("the signal comes from a DBC file"));
}

TEST(CalibHitchLogTest, RefusesALogWithoutAngles) {
    const tests::TemporaryFolder folder;
    { tests::MessageLog(folder / "empty.lcm").Clock(1000); }
    testing::internal::CaptureStderr();
    EXPECT_EQ(HitchVerb({.log = {folder / "empty.lcm"}}), 2);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("has no valid hitch angle"));
    EXPECT_EQ(HitchVerb({.log = {folder / "none.lcm"}}), 2);
}

/// The two cameras beside the hitch on the left, boards there, and pictures of three turns. The
/// calibration's frames begin elsewhere.
class CalibHitchTest : public testing::Test {
 protected:
    static constexpr double kTractorOff_m = 0.25;
    static constexpr double kTrailerOff_m = -0.15;

    CalibHitchTest() {
        calib::RigCalibration rig{.vehicle = "truck", .verdict = calib::Verdict::kPass};
        rig.written_by = "test";
        for (const auto& camera : drivers::SimulatedRigGeometry(640, 360)) {
            if (camera.name != "left_front" && camera.name != "left") continue;
            truth_.push_back(camera);
            algo::CameraGeometry own = camera.geometry;
            own.T_unit_camera.translation().x() +=
                camera.unit == algo::Unit::kTractor ? kTractorOff_m : kTrailerOff_m;
            rig.cameras[std::string(camera.name)] = calib::CalibratedCamera::From(camera.unit, own);
        }
        EXPECT_EQ(calib::SaveCalibration(rig, folder_ / "rig.yaml"), "");
        for (const Vector3d& middle_m : {Vector3d(3, 3.5, 1.2),
                                         {1.2, 3.2, 0.6},
                                         {-0.6, 3.2, 2.1},
                                         {-2.4, 3.5, 0.9},
                                         {0.2, 2.8, 1.3}})
            Hang(middle_m);
        const std::array<double, 3> turns_deg{0, 18, -18};
        for (std::size_t i = 0; i < turns_deg.size(); ++i)
            TakePictures(std::to_string(i), turns_deg.at(i) * kDegree);
    }

    void Hang(const Vector3d& middle_m) {
        const calib::Board board{.columns = 3,
                                 .rows = 2,
                                 .square_m = 0.4,
                                 .pattern = calib::Pattern::kTags,
                                 .tag_m = 0.32,
                                 .first_tag = 6 * static_cast<int>(boards_.size())};
        const std::string name = std::to_string(boards_.size()).append(".yaml");
        EXPECT_EQ(calib::SaveBoard(board, folder_ / name), "");
        Isometry3d T = Isometry3d::Identity();
        // Faces the vehicle: its z looks to the left, its y down.
        T.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
        T.linear() = T.linear() * Eigen::AngleAxisd(0.3, Vector3d(1, 1, 0).normalized());
        T.translation() = middle_m - T.linear() * (board.Corner(board.count() - 2) / 2);
        boards_.push_back({board, T});
    }

    void TakePictures(const std::string& shot, double articulation_rad) {
        for (const auto& camera : truth_) {
            const std::string into = folder_ / std::string(camera.name);
            std::filesystem::create_directory(into);
            Isometry3d T_world_unit = Isometry3d::Identity();
            if (camera.unit == algo::Unit::kTrailer)
                T_world_unit.rotate(Eigen::AngleAxisd(articulation_rad, Vector3d::UnitZ()));
            cv::imwrite(into + "/" + shot + ".png",
                        tests::BoardScene(camera.geometry.model)
                            .Render(T_world_unit * camera.geometry.T_unit_camera, boards_,
                                    {.blur_px = 0.5, .noise_grey = 2, .supersampling = 3}));
        }
    }

    tests::TemporaryFolder folder_;
    std::vector<drivers::SimulatedCameraGeometry> truth_;
    std::vector<tests::PlacedBoard> boards_;
};

TEST_F(CalibHitchTest, PutsTheOriginIntoTheHitchPoint) {
    const std::string session =
        folder_.Write("hitch.yaml",
                      "schema: 1\ncalibration: rig.yaml\n"
                      "pictures: {left_front: 'left_front/*.png', left: 'left/*.png'}\n"
                      "targets: {a: {board: 0.yaml}, b: {board: 1.yaml}, c: {board: 2.yaml}, d: "
                      "{board: 3.yaml},\n"
                      "  e: {board: 4.yaml}}\nstraight: ['0']\n");
    ASSERT_EQ(HitchVerb({.session = session,
                         .out = folder_ / "out.yaml",
                         .json = folder_ / "figures.json",
                         .command = "test"}),
              0);
    const auto loaded = calib::LoadCalibration(folder_ / "out.yaml");
    ASSERT_EQ(loaded.error, "");
    EXPECT_EQ(loaded.calibration->verdict, calib::Verdict::kPass);
    for (const auto& camera : truth_) {
        const Vector3d got = loaded.calibration->cameras.at(std::string(camera.name)).position_m;
        EXPECT_LT((got - camera.geometry.T_unit_camera.translation()).norm(), 0.005);
    }
    const auto figures = Read(folder_ / "figures.json");
    EXPECT_NEAR(figures["shots"][1]["yaw_deg"].get<double>(), 18, 0.1);
    EXPECT_FALSE(figures["height_is_measured"].get<bool>());
}

TEST_F(CalibHitchTest, NamesWhatIsWrongWithASession) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(HitchVerb({.session = folder_.Write(
                             "hitch.yaml",
                             "schema: 1\ncalibration: rig.yaml\nheight_m: 9\n"
                             "pictures: {left: 'left/*.png', rear: 'a'}\ntargets: {}\n")}),
              2);
    const std::string told = testing::internal::GetCapturedStderr();
    EXPECT_THAT(told, HasSubstr("hitch.yaml:3: height_m is 9, must be"));
    EXPECT_THAT(told, HasSubstr("must be of a camera of the calibration"));
    EXPECT_THAT(told, HasSubstr("at least one camera of the tractor"));
    EXPECT_THAT(told, HasSubstr("hitch.yaml:5: targets is a map, must be"));
}

}  // namespace
}  // namespace hitchview::app
