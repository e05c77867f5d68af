#include <gtest/gtest.h>

#include <regex>

#include "app/calib_formats_verb.hpp"
#include "calib/lens_file.hpp"
#include "tests/support/format_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using calib::Format;
using Kind = algo::CameraModel::Kind;

class CalibFormatsTest : public testing::Test {
 protected:
    std::string StderrOf(int expected_code, const std::function<int()>& verb) {
        testing::internal::CaptureStderr();
        EXPECT_EQ(verb(), expected_code);
        return testing::internal::GetCapturedStderr();
    }
    tests::TemporaryFolder folder_;
};

/// A file that the command "test" has written some day.
std::string WithoutDate(const std::string& text) {
    return std::regex_replace(text, std::regex(R"("test, 20\d\d-\d\d-\d\d \d\d:\d\d UTC")"),
                              "\"test\"");
}

TEST_F(CalibFormatsTest, ALensGoesOutAndComesBackUnchecked) {
    const algo::CameraModel lens = tests::FormatSamples(1).Lens(Kind::kKannalaBrandt4);
    ASSERT_EQ(calib::SaveUncheckedLens(lens, "test", folder_ / "lens.yaml"), "");
    const std::string warning = StderrOf(0, [&] {
        return CalibExportVerb(
            {.format = Format::kRos, .lens = folder_ / "lens.yaml", .out = folder_ / "ros.yaml"});
    });
    EXPECT_NE(warning.find("the verdict is unchecked"), warning.npos);
    EXPECT_EQ(CalibImportVerb({.format = Format::kRos,
                               .in = {folder_ / "ros.yaml"},
                               .out = folder_ / "back.yaml",
                               .command = "test"}),
              0);
    EXPECT_EQ(WithoutDate(tests::FileText(folder_ / "back.yaml")),
              tests::FileText(folder_ / "lens.yaml"));
}

TEST_F(CalibFormatsTest, ARigGoesThroughKalibrsChainsOfItsUnits) {
    const calib::RigCalibration rig = tests::FormatSamples(2).Rig(Kind::kKannalaBrandt4);
    ASSERT_EQ(calib::SaveCalibration(rig, folder_ / "rig.yaml"), "");
    EXPECT_EQ(CalibExportVerb({.format = Format::kKalibr,
                               .calibration = folder_ / "rig.yaml",
                               .out = folder_ / "chains"}),
              0);
    EXPECT_EQ(
        CalibImportVerb({.format = Format::kKalibr,
                         .in = {folder_ / "chains/tractor.yaml", folder_ / "chains/trailer.yaml"},
                         .out = folder_ / "back.yaml",
                         .units = {"tractor", "trailer"},
                         .command = "test"}),
        0);
    const auto back = calib::LoadCalibration(folder_ / "back.yaml");
    ASSERT_TRUE(back.calibration) << back.error;
    EXPECT_EQ(back.calibration->verdict, calib::Verdict::kUnchecked);
    for (const auto& [name, camera] : rig.cameras) {
        const calib::CalibratedCamera& got = back.calibration->cameras.at(name);
        EXPECT_EQ(got.unit, camera.unit);
        EXPECT_TRUE(got.Geometry().T_unit_camera.isApprox(camera.Geometry().T_unit_camera, 1e-12));
    }
}

TEST_F(CalibFormatsTest, ARigOfFisheyesIsNotWrittenForMrcalNotEvenInPart) {
    calib::RigCalibration rig = tests::FormatSamples(3).Rig(Kind::kPinholeRadtan);
    rig.cameras["rear"] =
        tests::FormatSamples(4).Camera(algo::Unit::kTrailer, Kind::kKannalaBrandt4);
    ASSERT_EQ(calib::SaveCalibration(rig, folder_ / "rig.yaml"), "");
    const std::string error = StderrOf(2, [&] {
        return CalibExportVerb({.format = Format::kMrcal,
                                .calibration = folder_ / "rig.yaml",
                                .out = folder_ / "mrcal"});
    });
    EXPECT_NE(error.find("rear is kannala_brandt4"), error.npos) << error;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "mrcal"));
}

TEST_F(CalibFormatsTest, BadInputIsWrongUseAndLeavesNoFile) {
    const std::string in = folder_.Write("in.yaml", "camera_matrix: [1, 2");
    EXPECT_NE(StderrOf(2, [&] { return CalibImportVerb({.in = {in}, .out = folder_ / "x.yaml"}); })
                  .find("in.yaml:1: "),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.yaml"));
}

TEST_F(CalibFormatsTest, UnitsAreGivenOnceOrForEachFile) {
    const algo::CameraModel lens = tests::FormatSamples(5).Lens(Kind::kPinholeRadtan);
    const std::string in =
        folder_.Write("a.cameramodel", ExportLens(Format::kMrcal, "a", lens).files.at(0).text);
    const auto import = [&](std::vector<std::string> units, const std::string& first) {
        return StderrOf(2, [&] {
            return CalibImportVerb({.format = Format::kMrcal,
                                    .in = {in, in, in},
                                    .out = folder_ / "x.yaml",
                                    .units = std::move(units),
                                    .first_camera = first});
        });
    };
    EXPECT_EQ(import({"tractor", "trailer"}, ""),
              "--unit is given 2 times, must be given once or for each of the 3 files\n");
    EXPECT_EQ(import({"truck"}, ""), "--unit is truck, must be tractor or trailer\n");
    EXPECT_EQ(import({"tractor"}, "1,2,3"),
              "--first-camera is 1,2,3, must be X,Y,Z,ROLL,PITCH,YAW in metres and degrees\n");
    EXPECT_NE(import({"tractor"}, "1,2,3,0,0,0").find("a is the name of two cameras"),
              std::string::npos);
}

}  // namespace
}  // namespace hitchview::app
