#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/persistence.hpp>

#include "calib/format.hpp"
#include "calib/format_rig.hpp"
#include "tests/support/format_samples.hpp"
#include "tests/support/format_test.hpp"
#include "tests/support/test_data.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Kind = CameraModel::Kind;
using tests::FormatSamples;

constexpr std::array kFormats{Format::kOpenCv, Format::kRos, Format::kKalibr, Format::kMrcal};

void ExpectSame(const CameraModel& got, const CameraModel& expected) {
    EXPECT_EQ(got.kind, expected.kind);
    EXPECT_EQ(got.width_px, expected.width_px);
    EXPECT_EQ(got.height_px, expected.height_px);
    EXPECT_EQ(got.fx_px, expected.fx_px);
    EXPECT_EQ(got.fy_px, expected.fy_px);
    EXPECT_EQ(got.cx_px, expected.cx_px);
    EXPECT_EQ(got.cy_px, expected.cy_px);
    EXPECT_EQ(got.distortion, expected.distortion);
    EXPECT_EQ(got.max_theta_rad, expected.max_theta_rad);
}

TEST_F(FormatTest, LensesComeBackBitForBit) {
    for (unsigned seed = 0; seed < 40; ++seed) {
        FormatSamples samples(seed);
        for (const Format format : kFormats) {
            for (const Kind kind : {Kind::kPinholeRadtan, Kind::kKannalaBrandt4}) {
                CameraModel lens = samples.Lens(kind);
                if (format == Format::kKalibr && kind == Kind::kPinholeRadtan) {
                    lens.distortion[4] = 0;
                    lens.max_theta_rad = FieldOf(lens);
                }
                const ExportedFiles exported = ExportLens(format, "front", lens);
                if (format == Format::kMrcal && kind == Kind::kKannalaBrandt4) {
                    EXPECT_NE(exported.error, "");
                    continue;
                }
                ASSERT_EQ(exported.error, "");
                const ForeignCameras back = Imported(format, exported.files.at(0).text);
                ASSERT_EQ(back.error, "");
                ExpectSame(back.cameras.at(0).model, lens);
            }
        }
    }
}

struct OpenCvLens {
    explicit OpenCvLens(const std::string& file) {
        const cv::FileStorage storage(file, cv::FileStorage::READ);
        storage["camera_matrix"] >> matrix;
        storage["distortion_coefficients"] >> distortion;
    }
    [[nodiscard]] Eigen::Vector2d Project(Kind kind, const Eigen::Vector3d& ray) const {
        const std::vector<cv::Point3d> points{{ray.x(), ray.y(), ray.z()}};
        const cv::Vec3d none(0, 0, 0);
        std::vector<cv::Point2d> pixels;
        if (kind == Kind::kPinholeRadtan) {
            cv::projectPoints(points, none, none, matrix, distortion, pixels);
        } else {
            cv::fisheye::projectPoints(points, pixels, none, none, matrix, distortion);
        }
        return {pixels[0].x, pixels[0].y};
    }
    cv::Mat matrix;
    cv::Mat distortion;
};

TEST_F(FormatTest, OpenCvProjectsWithAnExportedLensToTheSamePixels) {
    FormatSamples samples(1);
    for (int i = 0; i < 20; ++i) {
        for (const Kind kind : {Kind::kPinholeRadtan, Kind::kKannalaBrandt4}) {
            CameraModel lens = samples.Lens(kind);
            // OpenCV's fisheye divides by z.
            lens.max_theta_rad = std::min(lens.max_theta_rad, 1.5);
            const OpenCvLens opencv(folder_.Write(
                "lens.yaml", ExportLens(Format::kOpenCv, "a", lens).files.at(0).text));
            for (int k = 0; k < 100; ++k) {
                const Eigen::Vector3d ray = samples.Ray(lens);
                const auto pixel = lens.Project(ray);
                ASSERT_TRUE(pixel);
                EXPECT_LT((opencv.Project(kind, ray) - *pixel).norm(), 1e-9);
            }
        }
    }
}

TEST_F(FormatTest, WhatOpenCvWritesAsYamlXmlOrJsonIsTheSameLens) {
    const CameraModel lens = FormatSamples(2).Lens(Kind::kPinholeRadtan);
    const auto& d = lens.distortion;
    for (const char* const name : {"a.yaml", "a.xml", "a.json"}) {
        cv::FileStorage storage(folder_ / name, cv::FileStorage::WRITE);
        storage << "calibration_time"
                << "Mon 23 <Nov> & 'more'";
        storage << "image_width" << 1280 << "image_height" << 720;
        storage << "grid_points" << std::vector<cv::Point3f>{{1, 2, 3}, {4, 5, 6}};
        storage << "camera_matrix"
                << cv::Mat(
                       cv::Matx33d(lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1));
        storage << "distortion_coefficients"
                << cv::Mat(cv::Matx<double, 5, 1>(d[0], d[1], d[2], d[3], d[4]));
        storage << "avg_reprojection_error" << 0.25 << "names"
                << "["
                << "a b"
                << "c"
                << "]";
        storage.release();
        const ForeignCameras found = ImportCameras(Format::kOpenCv, folder_ / name, {});
        ASSERT_EQ(found.error, "") << tests::FileText(folder_ / name);
        ExpectSame(found.cameras.at(0).model, lens);
    }
}

TEST_F(FormatTest, ARigComesBackFromTheFormatsThatHavePlaces) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        RigCalibration rig = FormatSamples(seed).Rig(Kind::kPinholeRadtan);
        for (auto& [name, camera] : rig.cameras) {
            camera.model.distortion[4] = 0;
            camera.model.max_theta_rad = FieldOf(camera.model);
        }
        for (const Format format : {Format::kKalibr, Format::kMrcal}) {
            std::vector<UnitCameras> files;
            for (const ForeignFile& file : ExportRig(format, rig).files) {
                const std::string path = folder_.Write(file.name, file.text);
                const bool trailer = file.name.starts_with("rear") || file.name == "trailer.yaml";
                files.push_back({path, trailer ? algo::Unit::kTrailer : algo::Unit::kTractor,
                                 ImportCameras(format, path, {})});
                ASSERT_EQ(files.back().foreign.error, "");
            }
            const AssembledRig back = AssembleRig(files, "sample", {});
            ASSERT_TRUE(back.calibration) << back.error;
            ASSERT_EQ(back.calibration->cameras.size(), rig.cameras.size());
            for (const auto& [name, camera] : rig.cameras) {
                const CalibratedCamera& got = back.calibration->cameras.at(name);
                EXPECT_EQ(got.unit, camera.unit);
                ExpectSame(got.model, camera.model);
                EXPECT_TRUE(
                    got.Geometry().T_unit_camera.isApprox(camera.Geometry().T_unit_camera, 1e-12));
            }
        }
    }
}

const std::string kKalibrTail =
    "  camera_model: pinhole\n  intrinsics: [461.6, 460.2, 362.7, 246.2]\n"
    "  distortion_model: equidistant\n  distortion_coeffs: [-0.0027, 0.024, -0.03, 0.02]\n"
    "  rostopic: /cam0/image_raw\n  resolution: [752, 480]\n  cam_overlaps: [1]\n";
// The second camera stands 0.2 m to the right of the first: its frame's origin lies there, so that
// what is at 0 for the first is at -0.2 for the second.
const std::string kKalibr = "cam0:\n" + kKalibrTail +
                            "cam1:\n  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.2]\n"
                            "  - [0.0, 1.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n"
                            "  - [0.0, 0.0, 0.0, 1.0]\n" +
                            kKalibrTail;

TEST_F(FormatTest, AChainOfKalibrStandsWhereItsFirstCameraStands) {
    std::string text = kKalibr;
    text.replace(text.rfind("/cam0/"), 6, "/cam1/");
    const ForeignCameras chain = Imported(Format::kKalibr, text);
    ASSERT_EQ(chain.error, "");
    ASSERT_EQ(chain.cameras.size(), 2U);
    EXPECT_TRUE(chain.from_first_camera);
    EXPECT_FALSE(AssembleRig({{"f", algo::Unit::kTractor, chain}}, "v", {}).calibration);

    const auto first = ParseCameraPlace("4,0,2,0,0,0");  // looks forward
    ASSERT_TRUE(first);
    const auto rig = AssembleRig({{"f", algo::Unit::kTractor, chain}}, "v", first).calibration;
    ASSERT_TRUE(rig);
    EXPECT_TRUE(rig->cameras.at("cam0").position_m.isApprox(Eigen::Vector3d(4, 0, 2), 1e-12));
    EXPECT_TRUE(rig->cameras.at("cam1").position_m.isApprox(Eigen::Vector3d(4, -0.2, 2), 1e-12));
}

TEST_F(FormatTest, APlaceInTheUnitComesFromTCamImu) {
    const std::string text =
        "cam0:\n  T_cam_imu:\n  - [0, -1, 0, 0]\n  - [0, 0, -1, 2]\n"
        "  - [1, 0, 0, -4]\n  - [0, 0, 0, 1]\n" +
        kKalibrTail;
    const ForeignCameras chain = Imported(Format::kKalibr, text);
    ASSERT_EQ(chain.error, "");
    EXPECT_FALSE(chain.from_first_camera);
    const Eigen::Isometry3d& T = *chain.cameras.at(0).T_reference_camera;
    EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(4, 0, 2), 1e-12));
    EXPECT_TRUE((T.linear() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

TEST_F(FormatTest, TheMessageOfRosIsReadAsItsFile) {
    const std::string message =
        "header: {seq: 1}\nheight: 480\nwidth: 640\ndistortion_model: \"rational_polynomial\"\n"
        "D: [-0.2, 0.05, 0.001, -0.002, 0, 0, 0, 0]\nK: [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, "
        "0.0, "
        "0.0, 1.0]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nbinning_x: 0\n";
    const ForeignCameras found = Imported(Format::kRos, message);
    ASSERT_EQ(found.error, "");
    EXPECT_EQ(found.cameras.at(0).model.fy_px, 501);
    EXPECT_EQ(found.cameras.at(0).model.distortion[3], -0.002);
    EXPECT_EQ(found.cameras.at(0).name, "lens");
}

TEST_F(FormatTest, WhatHasNoPlaceHereIsRefusedInWords) {
    const std::string rational =
        "width: 640\nheight: 480\ndistortion_model: rational_polynomial\n"
        "D: [-0.2, 0.05, 0.001, -0.002, 0, 0.1, 0, 0]\nK: [500, 0, 320, 0, 501, 240, 0, 0, 1]\n";
    EXPECT_EQ(ErrorOf(Format::kRos, rational),
              "lens.txt:4: D is a list of 8, must be k1 k2 p1 p2 k3 and then zeros: rational, "
              "thin-prism and tilt terms have no place in pinhole_radtan; calibrate again without "
              "them");
    EXPECT_EQ(ErrorOf(Format::kMrcal,
                      "{'lensmodel': 'LENSMODEL_CAHVORE_linearity=0.34',\n"
                      "'intrinsics': [500, 500, 320, 240],\n'imagersize': [640, "
                      "480,],\n'extrinsics': [0,0,0,0,0,0],}"),
              "lens.txt:1: lensmodel is \"LENSMODEL_CAHVORE_linearity=0.34\", must be one of "
              "LENSMODEL_PINHOLE, LENSMODEL_OPENCV4, LENSMODEL_OPENCV5, LENSMODEL_OPENCV8, "
              "LENSMODEL_OPENCV12");
    std::string omni = kKalibr;
    omni.replace(omni.find("pinhole"), 7, "omni");
    EXPECT_EQ(ErrorOf(Format::kKalibr, omni),
              "lens.txt:2: cam0.camera_model is omni, must be pinhole");
    CameraModel k3 = FormatSamples(1).Lens(Kind::kPinholeRadtan);
    k3.distortion[4] = 0.5;
    EXPECT_EQ(ExportLens(Format::kKalibr, "front", k3).error,
              "front has k3 0.5, kalibr's pinhole-radtan has none: export to opencv, ros or mrcal, "
              "or calibrate as fisheye");
}

TEST_F(FormatTest, FourCoefficientsWithoutANameAreNotGuessed) {
    const std::string text =
        "%YAML:1.0\n---\nresolution: [640, 480]\nK: [[300, 0, 320], [0, 300, 240], [0, 0, 1]]\n"
        "D: [0.01, 0.001, 0.001, 0.001]\n";
    EXPECT_EQ(ErrorOf(Format::kOpenCv, text),
              "lens.txt:5: D is a list of 4, must be told apart: four may be a pinhole's k1 k2 p1 "
              "p2 or a fisheye's k1 k2 k3 k4; say --model pinhole or --model fisheye");
    for (const Kind kind : {Kind::kPinholeRadtan, Kind::kKannalaBrandt4}) {
        const ForeignCameras found = Imported(Format::kOpenCv, text, {.kind = kind});
        ASSERT_EQ(found.error, "");
        EXPECT_EQ(found.cameras.at(0).model.kind, kind);
    }
}

TEST_F(FormatTest, BytesOfMrcalsSolutionArePassedOver) {
    const CameraModel lens = FormatSamples(7).Lens(Kind::kPinholeRadtan);
    std::string text = ExportLens(Format::kMrcal, "a", lens).files.at(0).text;
    text.insert(text.rfind('}'),
                "    'optimization_inputs': b'" + std::string(3 << 20, '{') + "#!&*',\n");
    const ForeignCameras found = Imported(Format::kMrcal, text);
    ASSERT_EQ(found.error, "");
    ExpectSame(found.cameras.at(0).model, lens);
}

TEST(FormatDataTest, FilesOfOtherProgramsAreRead) {
    const std::string pinhole = tests::TestData("calib/pinhole/left_intrinsics.yml");
    const std::string pair = tests::TestData("calib/pinhole/intrinsics.yml");
    if (pinhole.empty() || pair.empty()) GTEST_SKIP() << "no recordings beside the source tree";
    const ForeignCameras lens = ImportCameras(Format::kOpenCv, pinhole, {});
    ASSERT_EQ(lens.error, "");
    EXPECT_EQ(lens.cameras.at(0).model.fx_px, 5.3591573396163199e+02);
    EXPECT_EQ(lens.cameras.at(0).model.distortion[4], 2.3839153080878486e-01);
    const ForeignCameras stereo =
        ImportCameras(Format::kOpenCv, pair, {.size_px = std::array{640, 480}});
    ASSERT_EQ(stereo.error, "");
    EXPECT_THAT(ImportCameras(Format::kOpenCv, pair, {}).error,
                testing::EndsWith("image_width is missing, must be given, or told with --size"));
    EXPECT_EQ(stereo.cameras.at(1).name, "right");

    for (const char* const side : {"front", "back", "left", "right"}) {
        const std::string file =
            tests::TestData(std::string("stills/fisheye-car/") + side + ".yaml");
        const ForeignCameras found =
            ImportCameras(Format::kOpenCv, file, {.kind = Kind::kKannalaBrandt4});
        ASSERT_EQ(found.error, "");
        EXPECT_EQ(found.cameras.at(0).model.width_px, 960);
        EXPECT_GT(found.cameras.at(0).model.max_theta_rad, 1.2);
    }
}

}  // namespace
}  // namespace hitchview::calib
