#include <gtest/gtest.h>

#include <cmath>

#include "app/config.hpp"
#include "calib/rig_calibration.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector3d;

const std::string kHead =
    "schema: 1\nvehicle: demo\nverdict: pass\nwritten_by: hitchview-calib unit\ncameras:\n";
const std::string kLens =
    "unit: tractor, model: kannala_brandt4, size_px: [1280, 720], focal_px: [560, 561], "
    "centre_px: [640, 360], distortion: [0, 0, 0, 0], max_theta_rad: 1.4";
const std::string kPose = ", rotation: {rpy_deg: [0, 0, 0]}, position_m: [1, 2, 3]";

std::string OneCamera(const std::string& content) {
    return kHead + "  a: {" + content + "}\n";
}

RigCalibration TwoCameras() {
    CalibratedCamera front;
    front.model = {.kind = algo::CameraModel::Kind::kKannalaBrandt4,
                   .width_px = 1280,
                   .height_px = 720,
                   .fx_px = 1.0e3 / 3,
                   .fy_px = std::sqrt(2.0) * 250,
                   .cx_px = 639.5,
                   .cy_px = 0.1 + 359.2,
                   .distortion = {-0.02, 1.0 / 300, -1e-9, 2e-17},
                   .max_theta_rad = 1.5};
    front.q_unit_camera = RotationFromRpy({0.1, 12.3, -33.3});
    front.position_m = {4.0 / 3, -0.1, 2.7};
    CalibratedCamera rear = front;
    rear.unit = algo::Unit::kTrailer;
    rear.model.kind = algo::CameraModel::Kind::kPinholeRadtan;
    rear.model.distortion = {-0.1, 0.01, 1e-4, -1e-4, 0.001};
    rear.model.max_theta_rad = 0.7;
    return {.vehicle = "demo \"one\": #2",
            .verdict = Verdict::kPass,
            .written_by = "hitchview-calib unit",
            .cameras = {{"front", front}, {"rear", rear}}};
}

class RigCalibrationTest : public testing::Test {
 protected:
    std::filesystem::path file() const { return folder_ / "calib.yaml"; }

    std::string ErrorOf(const std::string& text) {
        std::string error = LoadCalibration(folder_.Write("calib.yaml", text)).error;
        const std::string folder = folder_.path() + '/';
        for (auto at = error.find(folder); at != error.npos; at = error.find(folder)) {
            error.erase(at, folder.size());
        }
        return error;
    }

    tests::TemporaryFolder folder_;
};

TEST_F(RigCalibrationTest, ReadsBackWhatItWroteBitForBit) {
    const RigCalibration written = TwoCameras();
    ASSERT_EQ(SaveCalibration(written, file()), "");
    const LoadedCalibration loaded = LoadCalibration(file());
    ASSERT_TRUE(loaded.calibration) << loaded.error;
    const RigCalibration& read = *loaded.calibration;
    EXPECT_EQ(read.vehicle, written.vehicle);
    EXPECT_EQ(read.verdict, written.verdict);
    EXPECT_EQ(read.written_by, written.written_by);
    ASSERT_EQ(read.cameras.size(), 2U);
    for (const auto& [name, camera] : written.cameras) {
        const CalibratedCamera& other = read.cameras.at(name);
        EXPECT_EQ(other.unit, camera.unit);
        EXPECT_EQ(other.model.kind, camera.model.kind);
        EXPECT_EQ(other.model.fx_px, camera.model.fx_px);
        EXPECT_EQ(other.model.fy_px, camera.model.fy_px);
        EXPECT_EQ(other.model.cy_px, camera.model.cy_px);
        EXPECT_EQ(other.model.distortion, camera.model.distortion);
        EXPECT_EQ(other.model.max_theta_rad, camera.model.max_theta_rad);
        EXPECT_EQ(other.q_unit_camera.coeffs(), camera.q_unit_camera.coeffs());
        EXPECT_EQ(other.position_m, camera.position_m);
    }
    EXPECT_EQ(read.id(), written.id());
    EXPECT_EQ(ToYaml(read), ToYaml(written));
}

TEST_F(RigCalibrationTest, WhatCannotBeReadBackReplacesNothing) {
    ASSERT_EQ(SaveCalibration(TwoCameras(), file()), "");
    const std::string before = tests::FileText(file());
    RigCalibration bad = TwoCameras();
    bad.cameras.at("front").model.fx_px = -1;
    EXPECT_NE(SaveCalibration(bad, file()).find("focal_px[0] is -1, must be 10 to 20000"),
              std::string::npos);
    EXPECT_EQ(tests::FileText(file()), before);
    EXPECT_NE(SaveCalibration(TwoCameras(), folder_ / "no/folder.yaml"), "");
}

TEST_F(RigCalibrationTest, TheIdStandsForLensesAndPlacesOnly) {
    const RigCalibration calibration = TwoCameras();
    RigCalibration judged = calibration;
    judged.verdict = Verdict::kFail;
    judged.written_by = "somebody else";
    EXPECT_EQ(judged.id(), calibration.id());
    EXPECT_EQ(calibration.id().size(), 12U);

    RigCalibration moved = calibration;
    moved.cameras.at("rear").position_m.x() = std::nextafter(4.0 / 3, 2.0);
    EXPECT_NE(moved.id(), calibration.id());
}

TEST_F(RigCalibrationTest, CommentsAndLayoutDoNotChangeTheId) {
    const auto terse = LoadCalibration(folder_.Write("a.yaml", OneCamera(kLens + kPose)));
    std::string text = OneCamera(kLens + kPose);
    text.replace(text.find("560"), 3, "560.0");
    const auto chatty = LoadCalibration(folder_.Write("b.yaml", "# measured twice\n" + text));
    ASSERT_TRUE(terse.calibration && chatty.calibration) << terse.error << chatty.error;
    EXPECT_EQ(terse.calibration->id(), chatty.calibration->id());
}

TEST_F(RigCalibrationTest, AnEditedFileNoLongerMatchesItsId) {
    std::string text = ToYaml(TwoCameras());
    text.replace(text.find("639.5"), 5, "639.6");
    EXPECT_NE(ErrorOf(text).find("without the key nothing is compared"), std::string::npos);
}

TEST_F(RigCalibrationTest, RollPitchAndYawTurnTheCameraAsAPersonExpects) {
    const Vector3d ahead = Vector3d::UnitZ();  // of the camera
    EXPECT_LT((RotationFromRpy({0, 0, 0}) * ahead - Vector3d::UnitX()).norm(), 1e-12);
    EXPECT_LT((RotationFromRpy({0, 0, 90}) * ahead - Vector3d::UnitY()).norm(), 1e-12) << "left";
    EXPECT_LT((RotationFromRpy({0, 90, 0}) * ahead + Vector3d::UnitZ()).norm(), 1e-12) << "down";
    const Vector3d down = RotationFromRpy({0, 0, 37}) * Vector3d::UnitY();
    EXPECT_LT((down + Vector3d::UnitZ()).norm(), 1e-12) << "the image's y points to the ground";
    const Vector3d right = RotationFromRpy({0, 0, 0}) * Vector3d::UnitX();
    EXPECT_LT((right + Vector3d::UnitY()).norm(), 1e-12);
}

TEST_F(RigCalibrationTest, GeometryAndBackKeepsThePose) {
    const CalibratedCamera camera = TwoCameras().cameras.at("front");
    const CalibratedCamera back = CalibratedCamera::From(camera.unit, camera.Geometry());
    EXPECT_LT(back.q_unit_camera.angularDistance(camera.q_unit_camera), 1e-12);
    EXPECT_EQ(back.position_m, camera.position_m);
}

TEST_F(RigCalibrationTest, BadFilesAreRefusedWithFileLineKeyValueAndRange) {
    const auto with = [](std::string text, const std::string& what, const std::string& by) {
        return text.replace(text.find(what), what.size(), by);
    };
    const std::string good = OneCamera(kLens + kPose);
    ASSERT_EQ(ErrorOf(good), "");
    const std::vector<std::pair<std::string, std::string>> table{
        {with(good, "schema: 1", "schema: 3"), "calib.yaml:1: schema is 3, must be 1"},
        {with(good, "pass", "good"),
         "calib.yaml:3: verdict is good, must be one of pass, fail, unchecked"},
        {with(good, "vehicle: demo\n", ""), "calib.yaml:1: vehicle is missing, must be text"},
        {with(good, "  a: {", "  a-b: {"),
         "calib.yaml:6: cameras.a-b is a map, must be named with letters, digits and _ only"},
        {with(good, "unit: tractor", "unit: truck"),
         "calib.yaml:6: cameras.a.unit is truck, must be one of tractor, trailer"},
        {with(good, "kannala_brandt4", "fisheye"),
         "calib.yaml:6: cameras.a.model is fisheye, must be one of kannala_brandt4, "
         "pinhole_radtan"},
        {with(good, "[0, 0, 0, 0]", "[0, 0, 0, 0, 0]"),
         "calib.yaml:6: cameras.a.distortion is a list of 5, must be a list of 4"},
        {with(good, "[0, 0, 0, 0]", "[-0.9, 0, 0, 0]"),
         "calib.yaml:6: cameras.a.max_theta_rad is 1.4, must be smaller: the distortion stops "
         "growing before this angle"},
        {with(good, "max_theta_rad: 1.4", "max_theta_rad: 4"),
         "calib.yaml:6: cameras.a.max_theta_rad is 4, must be 0.05 to 3.14"},
        {with(good, "[560, 561]", "[560, x]"),
         "calib.yaml:6: cameras.a.focal_px[1] is x, must be a number, 10 to 20000"},
        {with(good, "rpy_deg", "rpy_rad"),
         "calib.yaml:6: cameras.a.rotation.rpy_rad is no key, must be one of quaternion_wxyz, "
         "rpy_deg\ncalib.yaml:6: cameras.a.rotation is a map, must be a map with either "
         "quaternion_wxyz or rpy_deg"},
        {with(good, "rpy_deg: [0, 0, 0]", "quaternion_wxyz: [1, 0, 0, 0.1]"),
         "calib.yaml:6: cameras.a.rotation.quaternion_wxyz is a list of 4, must be of length 1 "
         "within 1e-6"},
        {with(good, ", position_m: [1, 2, 3]", ""),
         "calib.yaml:6: cameras.a.position_m is missing, must be a list of 3"},
        {with(good, "schema: 1", "schema: 1\nscale: 2"),
         "calib.yaml:2: scale is no key, must be one of schema, vehicle, verdict, written_by, "
         "cameras, id"},
        {kHead.substr(0, kHead.size() - 1) + " {}\n",
         "calib.yaml:5: cameras is a map, must be a map of cameras by name"},
    };
    for (const auto& [text, error] : table) EXPECT_EQ(ErrorOf(text), error) << text;
}

TEST_F(RigCalibrationTest, TheExampleInTheConventionsLoads) {
    const std::string page = tests::FileText(HITCHVIEW_SOURCE_DIR "/docs/conventions.md");
    const std::string fence = "```yaml\n";
    const auto start = page.find(fence) + fence.size();
    EXPECT_EQ(ErrorOf(page.substr(start, page.find("```", start) - start)), "");
}

TEST_F(RigCalibrationTest, ARigNeedsEachOfItsCamerasOnTheSameUnit) {
    app::RigConfig rig;
    rig.calibration = folder_.Write("calib.yaml", OneCamera(kLens + kPose));
    rig.units[algo::Unit::kTractor].cameras = {{.name = "a"}};
    EXPECT_TRUE(app::LoadCalibrationFor(rig).ok());

    std::swap(rig.units[algo::Unit::kTractor], rig.units[algo::Unit::kTrailer]);
    EXPECT_EQ(
        app::LoadCalibrationFor(rig).error(),
        rig.calibration.string() + ": cameras.a.unit is tractor, must be trailer for this rig");
    rig.units[algo::Unit::kTrailer].cameras = {{.name = "b"}};
    EXPECT_EQ(app::LoadCalibrationFor(rig).error(),
              rig.calibration.string() + ": cameras.b is missing, must be there for this rig");
}

}  // namespace
}  // namespace hitchview::calib
