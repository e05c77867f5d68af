#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "app/calib_capture_verb.hpp"
#include "calib/board_detector.hpp"
#include "drivers/simulated_rig.hpp"
#include "tests/support/board_scene.hpp"
#include "tests/support/log_messages.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

const calib::Board kBoard{
    .columns = 9, .rows = 6, .square_m = 0.06, .pattern = calib::Pattern::kCharuco, .tag_m = 0.042};
const algo::CameraModel kLens{.kind = algo::CameraModel::Kind::kKannalaBrandt4,
                              .width_px = 480,
                              .height_px = 300,
                              .fx_px = 220,
                              .fy_px = 220,
                              .cx_px = 242,
                              .cy_px = 147,
                              .distortion = {0.02, -0.005, 0.001},
                              .max_theta_rad = 1.4};

class CaptureTest : public testing::Test {
 protected:
    void SetUp() override {
        std::filesystem::create_directory(folder_.path() + "/seen");
        ASSERT_EQ(calib::SaveBoard(kBoard, folder_.path() + "/board.yaml"), "");
        options_.board = folder_.path() + "/board.yaml";
        options_.images = folder_.path() + "/seen/*.png";
        options_.camera = "front";
        options_.out = folder_.path() + "/kept";
        options_.json = folder_.path() + "/capture.json";
    }

    /// A person holds the board before the camera, all over the picture.
    void HoldAnywhere(int pictures) {
        const tests::BoardScene scene(kLens);
        std::mt19937 random(5);
        std::uniform_real_distribution<double> u(0, 1);
        for (int i = 0; i < pictures; ++i) {
            const double distance_m = 0.25 + 0.75 * u(random);
            const double y_px = 300 * u(random);
            const double x_px = 480 * u(random);
            const Eigen::Vector2d at(x_px, y_px);
            const double tilt_rad = 1.4 * (u(random) - 0.5);
            Save(i, scene.Render(Eigen::Isometry3d::Identity(),
                                 std::vector<tests::PlacedBoard>{
                                     {kBoard, tests::Held(kLens, kBoard, at, distance_m, tilt_rad,
                                                          6 * u(random))}},
                                 {.blur_px = 0.6, .supersampling = 2, .seed = 7}));
        }
    }
    [[nodiscard]] std::string Seen(int number) const {
        char name[32];
        std::snprintf(name, sizeof name, "/seen/%04d.png", number);
        return folder_.path() + name;
    }
    void Save(int number, const cv::Mat& picture) const {
        ASSERT_TRUE(cv::imwrite(Seen(number), picture));
    }
    [[nodiscard]] nlohmann::json Report() const {
        std::ifstream file(options_.json);
        return nlohmann::json::parse(file);
    }
    [[nodiscard]] std::vector<std::string> Kept() const {
        std::vector<std::string> kept;
        cv::glob(folder_.path() + "/kept/front/*.png", kept);
        return kept;
    }

    tests::TemporaryFolder folder_;
    CaptureOptions options_;
};

/// Focal length that OpenCV finds from the pictures.
double FocalFrom(const std::vector<std::string>& pictures, const cv::Size& size_px) {
    std::vector<std::vector<cv::Point3d>> board;
    std::vector<std::vector<cv::Point2d>> corners;
    for (const std::string& picture : pictures) {
        const auto seen =
            calib::DetectBoards(cv::imread(picture, cv::IMREAD_GRAYSCALE), {&kBoard, 1});
        board.emplace_back();
        corners.emplace_back();
        for (const calib::SeenCorner& corner : seen.front()) {
            const Eigen::Vector3d at_m = kBoard.Corner(corner.index);
            board.back().emplace_back(at_m.x(), at_m.y(), 0);
            corners.back().emplace_back(corner.at_px.x(), corner.at_px.y());
        }
    }
    cv::Mat camera =
        (cv::Mat_<double>(3, 3) << 200, 0, size_px.width / 2, 0, 200, size_px.height / 2, 0, 0, 1);
    cv::Mat distortion = cv::Mat::zeros(4, 1, CV_64F);
    cv::fisheye::calibrate(board, corners, size_px, camera, distortion, cv::noArray(),
                           cv::noArray(),
                           cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW |
                               cv::fisheye::CALIB_USE_INTRINSIC_GUESS);
    return camera.at<double>(0, 0);
}

TEST_F(CaptureTest, PicturesThatAreKeptAreEnoughForTheLens) {
    HoldAnywhere(120);

    ASSERT_EQ(CaptureVerb(options_), 0);
    const std::vector<std::string> kept = Kept();
    EXPECT_GE(kept.size(), 20U);
    EXPECT_LE(kept.size(), 60U);
    EXPECT_EQ(Report()["cameras"][0]["views"], kept.size());
    EXPECT_LT(Report()["cameras"][0]["pictures"], 120) << "it goes on when it has enough";
    EXPECT_NEAR(FocalFrom(kept, {480, 300}), 220, 1);
}

TEST_F(CaptureTest, ASourceThatEndsEarlyIsNotEnough) {
    HoldAnywhere(4);

    EXPECT_EQ(CaptureVerb(options_), 1);
    EXPECT_EQ(Report()["enough"], false);
    EXPECT_FALSE(Report()["cameras"][0]["missing"].empty());
    EXPECT_LE(Kept().size(), 4U);
}

TEST_F(CaptureTest, BeforeASimulatedRigTheBoardIsHeldUntilItIsEnough) {
    options_.images.clear();
    options_.camera.clear();
    options_.rig =
        folder_.Write("rig.yaml",
                      "schema: 1\n"
                      "canvas: {projection: plane, size_px: [640, 480]}\n"
                      "units:\n"
                      "  tractor: {cameras: [{name: front, source: {simulated: true}}]}\n"
                      "  trailer: {cameras: [{name: rear, source: {simulated: true}}]}\n"
                      "simulation: {camera_size_px: [400, 260], frames: 400}\n"
                      "publish: {url: 'memq://'}\n");

    ASSERT_EQ(CaptureVerb(options_), 0);
    EXPECT_EQ(Report()["cameras"].size(), 2U);
    const drivers::SimulatedRigGeometryTable truth = drivers::SimulatedRigGeometry(400, 260);
    EXPECT_NEAR(FocalFrom(Kept(), {400, 260}), truth[0].geometry.model.fx_px, 1);
}

TEST_F(CaptureTest, OneCameraOfARecordingIsLookedAt) {
    HoldAnywhere(5);
    auto log = std::make_unique<tests::MessageLog>(folder_ / "drive.lcm");
    for (int i = 0; i < 5; ++i) {
        tests::LoggedPicture picture{
            .captured_ns = i * 33'000'000, .width_px = 480, .height_px = 300};
        cv::imencode(".jpg", cv::imread(Seen(i)), picture.data);
        for (int times = 0; times < 2; ++times) log->Picture("CAM_FRONT", picture);
        log->Picture("CAM_REAR", picture);
    }
    log.reset();
    options_.images.clear();
    EXPECT_EQ(CaptureVerb(options_), 2) << "no source";
    options_.log = folder_ / "drive.lcm";

    EXPECT_EQ(CaptureVerb(options_), 1);
    EXPECT_EQ(Report()["cameras"][0]["pictures"], 10);
    EXPECT_GE(Kept().size(), 4U) << "those in which the board rests";
}

TEST_F(CaptureTest, WrongUseIsRefused) {
    EXPECT_EQ(CaptureVerb(options_), 2) << "no picture";
    HoldAnywhere(1);
    options_.video = "film.mp4";
    EXPECT_EQ(CaptureVerb(options_), 2) << "two sources";
    options_.video.clear();
    EXPECT_EQ(CaptureVerb(options_), 1);
    EXPECT_EQ(CaptureVerb(options_), 2) << "pictures of another time are there";
}

}  // namespace
}  // namespace hitchview::app
