#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/calib_unit_verb.hpp"
#include "calib/board_pattern.hpp"
#include "calib/lens_file.hpp"
#include "calib/rig_calibration.hpp"
#include "calib/unit_solver.hpp"
#include "drivers/simulated_rig.hpp"
#include "tests/support/board_scene.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 360;
constexpr double kDegree = std::numbers::pi / 180;

/// A board, and where a camera has its middle.
struct Hung {
    std::size_t camera;
    double x_px, y_px, distance_m;
};
constexpr std::array<Hung, 6> kHung{{{0, 330, 60, 3.5},
                                     {0, 520, 230, 2.4},
                                     {0, 135, 200, 2.8},  // seen by both
                                     {1, 330, 70, 3.5},
                                     {1, 150, 220, 2.4},
                                     {1, 250, 290, 2.8}}};
constexpr std::size_t kBoards = kHung.size();

/// The first two cameras of the simulated tractor, boards before them, and what they see as files.
class CalibUnitTest : public testing::Test {
 protected:
    static void SetUpTestSuite() { yard_ = new Yard; }
    static void TearDownTestSuite() { delete yard_; }

    struct Yard {
        Yard() {
            for (const auto& camera : drivers::SimulatedRigGeometry(kWidth_px, kHeight_px)) {
                if (cameras.size() < 2) cameras.push_back(camera);
            }
            for (std::size_t i = 0; i < kBoards; ++i) Hang(kHung.at(i));
            for (const auto& camera : cameras) {
                SaveLens(camera);
                TakePictures(camera);
            }
        }

        void Hang(const Hung& hung) {
            const calib::Board board{.columns = 3,
                                     .rows = 2,
                                     .square_m = 0.4,
                                     .pattern = calib::Pattern::kTags,
                                     .tag_m = 0.32,
                                     .first_tag = 6 * static_cast<int>(boards.size())};
            const std::string name = "t" + std::to_string(boards.size()) + ".yaml";
            EXPECT_EQ(calib::SaveBoard(board, folder / name), "");
            const algo::CameraGeometry& camera = cameras[hung.camera].geometry;
            const double tilt_rad = hung.x_px < 200 ? -0.4 : 0.4;
            boards.push_back({board, camera.T_unit_camera *
                                         tests::Held(camera.model, board, {hung.x_px, hung.y_px},
                                                     hung.distance_m, tilt_rad, 1.2)});
        }

        void SaveLens(const drivers::SimulatedCameraGeometry& camera) const {
            calib::Intrinsics lens{.model = camera.geometry.model};
            lens.verdict = calib::Verdict::kPass;
            ASSERT_EQ(calib::SaveLens(lens, "test", folder / (std::string(camera.name) + ".yaml")),
                      "");
        }

        void TakePictures(const drivers::SimulatedCameraGeometry& camera) const {
            const std::string into = folder / std::string(camera.name);
            std::filesystem::create_directory(into);
            const tests::BoardScene scene(camera.geometry.model);
            cv::imwrite(into + "/1.png", scene.Render(camera.geometry.T_unit_camera, boards,
                                                      {.blur_px = 0.5, .noise_grey = 2}));
        }

        tests::TemporaryFolder folder;
        std::vector<drivers::SimulatedCameraGeometry> cameras;
        std::vector<tests::PlacedBoard> boards;
    };

    /// What a person would write; `surveyed`: targets whose corners are known.
    [[nodiscard]] std::string Session(std::size_t surveyed, bool swapped) const {
        std::string text = "schema: 1\nunit: tractor\nvehicle: truck\ncameras:\n";
        for (const auto& camera : yard_->cameras) {
            const std::string name(camera.name);
            const std::string of = swapped == (name == "front") ? "left_front" : "front";
            text += "  " + name + ": {lens: " + (yard_->folder / name) + ".yaml, pictures: '" +
                    (yard_->folder / of) + "/*.png', yaw_deg: " + (name == "front" ? "10" : "60") +
                    "}\n";
        }
        text += "targets:\n";
        for (std::size_t i = 0; i < kBoards; ++i) text += Target(i, i < surveyed);
        return folder_.Write("session.yaml", text);
    }

    [[nodiscard]] std::string Target(std::size_t i, bool surveyed) const {
        const auto& [board, place] = yard_->boards[i];
        const std::string name = "t" + std::to_string(i);
        const std::string text = "  " + name + ": {board: " + (yard_->folder / name) + ".yaml";
        if (!surveyed) return text + "}\n";
        const calib::BoardRectangle area = calib::PatternArea(board);
        const auto corner = [&](const char* which, double x, double y) {
            const Vector3d p = place * Vector3d(x, y, 0);
            return std::string("{corner: ") + which + ", at_m: [" + std::to_string(p.x()) + ", " +
                   std::to_string(p.y()) + ", " + std::to_string(p.z()) + "]}";
        };
        return text + ", sigma_m: 0.001, surveyed: [" +
               corner("top_left", area.from_m.x(), area.from_m.y()) + ", " +
               corner("top_right", area.to_m.x(), area.from_m.y()) + ", " +
               corner("bottom_right", area.to_m.x(), area.to_m.y()) + "]}\n";
    }

    [[nodiscard]] UnitOptions Options(std::size_t surveyed, bool swapped = false) const {
        return {.session = Session(surveyed, swapped),
                .out = folder_ / "rig.yaml",
                .json = folder_ / "figures.json",
                .command = "test"};
    }

    static Yard* yard_;
    tests::TemporaryFolder folder_;
};

CalibUnitTest::Yard* CalibUnitTest::yard_ = nullptr;

TEST_F(CalibUnitTest, PicturesOfSurveyedTargetsGiveACalibrationThatPasses) {
    UnitOptions options = Options(kBoards);
    options.view = folder_ / "view.png";
    options.maps = folder_ / "maps";
    ASSERT_EQ(UnitVerb(options), 0);

    const auto loaded = calib::LoadCalibration(options.out);
    ASSERT_EQ(loaded.error, "");
    EXPECT_EQ(loaded.calibration->verdict, calib::Verdict::kPass);
    for (const auto& camera : yard_->cameras) {
        const Isometry3d got =
            loaded.calibration->cameras.at(std::string(camera.name)).Geometry().T_unit_camera;
        const Isometry3d& truth = camera.geometry.T_unit_camera;
        EXPECT_LT(Eigen::AngleAxisd(got.linear().transpose() * truth.linear()).angle(),
                  0.05 * kDegree);
        EXPECT_LT((got.translation() - truth.translation()).norm(), 0.005);
    }
    const cv::Mat view = cv::imread(options.view.string());
    EXPECT_EQ(view.size(), cv::Size(4096, 1024));
    EXPECT_GT(cv::mean(view)[0], 10);
    const cv::Mat map = cv::imread((options.maps / "front.tiff").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(map.type(), CV_32FC3);
    // The front camera looks into the middle of the tractor's view.
    const cv::Vec3f middle = map.at<cv::Vec3f>(460, 2048);
    EXPECT_NEAR(middle[2], kWidth_px / 2.0, 2);
    EXPECT_EQ(middle[0], 1);
}

TEST_F(CalibUnitTest, RefusesCamerasThatNothingLinks) {
    const UnitOptions options = Options(0);
    testing::internal::CaptureStderr();
    EXPECT_EQ(UnitVerb(options), 2);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("the unit frame is not fixed"));
    EXPECT_FALSE(std::filesystem::exists(options.out));
}

TEST_F(CalibUnitTest, WritesNoCalibrationThatFailedUnlessItIsToBeKept) {
    UnitOptions options = Options(kBoards, true);
    testing::internal::CaptureStdout();
    EXPECT_EQ(UnitVerb(options), 1);
    EXPECT_THAT(testing::internal::GetCapturedStdout(),
                HasSubstr("are the pictures of front and left_front swapped?"));
    EXPECT_FALSE(std::filesystem::exists(options.out));

    options.keeps_failed = true;
    EXPECT_EQ(UnitVerb(options), 1);
    EXPECT_EQ(calib::LoadCalibration(options.out).calibration->verdict, calib::Verdict::kFail);
}

TEST_F(CalibUnitTest, KeepsTheOtherUnitOfARigAndItsVerdict) {
    calib::RigCalibration rig{.vehicle = "truck", .verdict = calib::Verdict::kUnchecked};
    rig.written_by = "test";
    rig.cameras["rear"] =
        calib::CalibratedCamera::From(algo::Unit::kTrailer, yard_->cameras[0].geometry);
    rig.cameras["gone"] =
        calib::CalibratedCamera::From(algo::Unit::kTractor, yard_->cameras[0].geometry);
    UnitOptions options = Options(kBoards);
    options.into = folder_ / "into.yaml";
    ASSERT_EQ(calib::SaveCalibration(rig, options.into), "");
    ASSERT_EQ(UnitVerb(options), 0);

    const auto loaded = calib::LoadCalibration(options.out);
    ASSERT_EQ(loaded.error, "");
    EXPECT_EQ(loaded.calibration->verdict, calib::Verdict::kUnchecked);
    EXPECT_EQ(loaded.calibration->cameras.size(), 3U);
    EXPECT_TRUE(loaded.calibration->cameras.contains("rear"));

    rig.vehicle = "another";
    ASSERT_EQ(calib::SaveCalibration(rig, options.into), "");
    EXPECT_EQ(UnitVerb(options), 2);
}

}  // namespace
}  // namespace hitchview::app
