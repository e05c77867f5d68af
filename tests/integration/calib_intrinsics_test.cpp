#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/board_pictures.hpp"
#include "tests/support/board_views.hpp"
#include "tests/support/calib_program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_data.hpp"

// `hitchview-calib intrinsics` on pictures.
namespace hitchview {
namespace {

using calib::Board;
using nlohmann::json;
using tests::CalibOutcome;
using tests::RunCalib;

/// As many as a person takes.
constexpr int kViews = 30;
constexpr Board kBoard{.columns = 9, .rows = 6, .square_m = 0.07};

algo::CameraModel HalfSize(algo::CameraModel lens) {
    lens.width_px /= 2;
    lens.height_px /= 2;
    for (double* value : {&lens.fx_px, &lens.fy_px, &lens.cx_px, &lens.cy_px}) *value /= 2;
    return lens;
}

json ReadJson(const std::string& file) {
    return json::parse(std::ifstream(file));
}

class CalibIntrinsicsTest : public testing::Test {
 protected:
    /// `views` pictures of `board`, 640 wide.
    void Take(const algo::CameraModel& lens, int views, double blur_px = 0.8) {
        tests::BoardPictures pictures(lens, kBoard, 3);
        for (int view = 0; view < views; ++view)
            Keep(pictures.Picture(pictures.NextPlace(), blur_px));
    }
    void Keep(const cv::Mat& picture) {
        cv::imwrite(folder_ / (std::to_string(100 + taken_++) + ".png"), picture);
    }
    CalibOutcome Measure(const std::string& board, const std::string& model = "fisheye") {
        return RunCalib("intrinsics --images '" + (folder_ / "*.png") + "' --board " + board +
                        " --model " + model + " --out " + (folder_ / "lens.yaml") + " --json " +
                        (folder_ / "lens.json"));
    }
    [[nodiscard]] bool HasLens() const { return std::filesystem::exists(folder_ / "lens.yaml"); }

    tests::TemporaryFolder folder_;
    int taken_ = 0;
};

void ExpectLens(const json& found, const algo::CameraModel& truth) {
    EXPECT_NEAR(found["focal_px"][0], truth.fx_px, 0.001 * truth.fx_px);
    EXPECT_NEAR(found["focal_px"][1], truth.fy_px, 0.001 * truth.fy_px);
    // Half a pixel of a picture of 1280 px.
    EXPECT_NEAR(found["centre_px"][0], truth.cx_px, 0.25);
    EXPECT_NEAR(found["centre_px"][1], truth.cy_px, 0.25);
}

TEST_F(CalibIntrinsicsTest, NoisyPicturesInChangingLightGiveAFisheyeBack) {
    const algo::CameraModel truth = HalfSize(tests::FisheyeLens());
    Take(truth, kViews);
    const CalibOutcome outcome = Measure("9x6,0.07");

    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const json figures = ReadJson(folder_ / "lens.json");
    EXPECT_EQ(figures["verdict"], "pass");
    EXPECT_EQ(figures["views_found"], kViews);
    EXPECT_LT(figures["rms_px"], 0.15);
    EXPECT_LT(figures["heldout_rms_px"], 0.2);
    ExpectLens(figures["lens"], truth);
    EXPECT_TRUE(HasLens());
}

TEST_F(CalibIntrinsicsTest, AndAPinhole) {
    const algo::CameraModel truth = HalfSize(tests::PinholeLens());
    Take(truth, kViews);
    const CalibOutcome outcome = Measure("9x6,0.07", "pinhole");

    ASSERT_EQ(outcome.code, 0) << outcome.text;
    ExpectLens(ReadJson(folder_ / "lens.json")["lens"], truth);
}

TEST_F(CalibIntrinsicsTest, ACameraOutOfFocusGetsNoFile) {
    Take(HalfSize(tests::FisheyeLens()), 8, 3.5);
    const CalibOutcome outcome = Measure("9x6,0.07");

    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_TRUE(outcome.Says("focus the camera")) << outcome.text;
    EXPECT_FALSE(HasLens());
}

TEST_F(CalibIntrinsicsTest, AWrongCountOfCornersIsSaid) {
    Take(HalfSize(tests::FisheyeLens()), 6);
    const CalibOutcome outcome = Measure("8x6,0.07");

    EXPECT_EQ(outcome.code, 2) << outcome.text;
    EXPECT_TRUE(outcome.Says("goes on beyond 8x6") || outcome.Says("count the corners"))
        << outcome.text;
    EXPECT_FALSE(HasLens());
}

TEST_F(CalibIntrinsicsTest, TooFewViewsGetNoFile) {
    Take(HalfSize(tests::FisheyeLens()), 4);
    const CalibOutcome outcome = Measure("9x6,0.07");

    EXPECT_EQ(outcome.code, 1);
    EXPECT_TRUE(outcome.Says("only 4 views can be used")) << outcome.text;
    EXPECT_FALSE(HasLens());
}

TEST_F(CalibIntrinsicsTest, BoardsThatAllFaceTheCameraGetNoFile) {
    const algo::CameraModel lens = HalfSize(tests::PinholeLens());
    tests::BoardPictures pictures(lens, kBoard, 3);
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector2d middle(120 + 57 * i, 120 + 20 * (i % 4));
        Keep(pictures.Picture(tests::Held(lens, kBoard, middle, 1.4)));
    }
    const CalibOutcome outcome = Measure("9x6,0.07", "pinhole");

    EXPECT_EQ(outcome.code, 1);
    EXPECT_TRUE(outcome.Says("all boards face the camera")) << outcome.text;
    EXPECT_FALSE(HasLens());
}

TEST_F(CalibIntrinsicsTest, WrongUseIsTold) {
    EXPECT_EQ(Measure("9x6,0.07").code, 2);  // no pictures
    Keep(cv::Mat1b(360, 640, 100));
    const CalibOutcome nothing = Measure("9x6,0.07");
    EXPECT_EQ(nothing.code, 2);
    EXPECT_TRUE(nothing.Says("in 0 of 1 pictures")) << nothing.text;
    EXPECT_EQ(Measure("9x6").code, 2);
    Keep(cv::Mat1b(300, 640, 100));
    EXPECT_TRUE(Measure("9x6,0.07").Says("is 640x300, must be 640x360"));
}

/// Real pictures, and how OpenCV does with them.
struct RealSet {
    const char* name;
    const char* pictures;
    Board board;
    const char* model;
    double most_rms_px;
};

class RealBoardsTest : public testing::TestWithParam<RealSet> {};

struct OpenCvLens {
    int found = 0;
    double rms_px = 0;
};

OpenCvLens MeasureByOpenCv(const std::string& folder, const RealSet& set) {
    const cv::Size size(set.board.columns, set.board.rows);
    std::vector<cv::Point3f> flat;
    for (const auto& corner : set.board.Corners()) flat.emplace_back(corner.x(), corner.y(), 0);
    std::vector<std::vector<cv::Point2f>> seen;
    std::vector<cv::String> files;
    cv::glob(folder + "/" + set.pictures, files);
    cv::Mat grey;
    for (const cv::String& file : files) {
        grey = cv::imread(file, cv::IMREAD_GRAYSCALE);
        std::vector<cv::Point2f> corners;
        if (!cv::findChessboardCorners(grey, size, corners)) continue;
        cv::cornerSubPix(grey, corners, {5, 5}, {-1, -1},
                         {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 40, 1e-3});
        seen.push_back(corners);
    }
    const std::vector<std::vector<cv::Point3f>> boards(seen.size(), flat);
    cv::Mat camera;
    cv::Mat distortion;
    if (std::string(set.model) == "pinhole")
        return {static_cast<int>(seen.size()),
                cv::calibrateCamera(boards, seen, grey.size(), camera, distortion, cv::noArray(),
                                    cv::noArray())};
    return {static_cast<int>(seen.size()),
            cv::fisheye::calibrate(
                boards, seen, grey.size(), camera, distortion, cv::noArray(), cv::noArray(),
                cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW)};
}

TEST_P(RealBoardsTest, AreFoundAsOftenAndExplainedNoWorseThanByOpenCv) {
    const RealSet& set = GetParam();
    const std::string folder = tests::TestData(std::string("calib/") + set.name);
    if (folder.empty()) GTEST_SKIP() << "no test data";
    const tests::TemporaryFolder out;
    const std::string board = std::to_string(set.board.columns) + "x" +
                              std::to_string(set.board.rows) + "," +
                              std::to_string(set.board.square_m);
    const CalibOutcome outcome =
        RunCalib("intrinsics --images '" + folder + "/" + set.pictures + "' --board " + board +
                 " --model " + set.model + " --json " + (out / "lens.json"));

    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const json figures = ReadJson(out / "lens.json");
    const OpenCvLens opencv = MeasureByOpenCv(folder, set);
    EXPECT_GE(figures["views_found"], opencv.found);
    EXPECT_LE(figures["rms_px"], opencv.rms_px);
    EXPECT_LE(figures["rms_px"], set.most_rms_px);
    EXPECT_FALSE(figures["heldout_rms_px"].is_null());
    std::printf("%s: %.3f px, left out %.3f; OpenCV %.3f px\n", set.name,
                figures["rms_px"].get<double>(), figures["heldout_rms_px"].get<double>(),
                opencv.rms_px);
}

INSTANTIATE_TEST_SUITE_P(
    Sets, RealBoardsTest,
    testing::Values(
        RealSet{
            "chessboard_1", "*.jpg", {.columns = 7, .rows = 7, .square_m = 0.1}, "fisheye", 0.6},
        RealSet{
            "chessboard_2", "*.jpg", {.columns = 7, .rows = 7, .square_m = 0.1}, "fisheye", 0.6},
        RealSet{"pinhole", "*.jpg", {.columns = 9, .rows = 6, .square_m = 0.025}, "pinhole", 0.4}),
    [](const auto& set) { return std::string(set.param.name); });

}  // namespace
}  // namespace hitchview
