#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <opencv2/calib3d.hpp>

#include "calib/chessboard_detector.hpp"
#include "calib/intrinsics.hpp"
#include "calib/view_selection.hpp"
#include "tests/support/board_views.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using tests::BoardViews;

constexpr Board kBoard{.columns = 9, .rows = 6, .square_m = 0.04};
constexpr double kNoise_px = 0.3;

class LensTest : public testing::TestWithParam<CameraModel> {};

TEST_P(LensTest, PicturesWithoutNoiseGiveTheLensBack) {
    const CameraModel truth = GetParam();
    const auto found = SolveLens(BoardViews(truth, kBoard, 1).Problem(15, 0), {});

    ASSERT_TRUE(found);
    EXPECT_LT(found->rms_px, 1e-4);
    EXPECT_NEAR(found->model.fx_px, truth.fx_px, 1e-3);
    EXPECT_NEAR(found->model.fy_px, truth.fy_px, 1e-3);
    EXPECT_NEAR(found->model.cx_px, truth.cx_px, 1e-3);
    EXPECT_NEAR(found->model.cy_px, truth.cy_px, 1e-3);
}

TEST_P(LensTest, PartsOfABoardWithTagsGiveTheLensBack) {
    const CameraModel truth = GetParam();
    const Board tags{.columns = 6,
                     .rows = 4,
                     .square_m = 0.08,
                     .pattern = Pattern::kTags,
                     .tag_m = 0.06,
                     .first_tag = 0};
    BoardViews views(truth, tags, 12);
    views.ShowParts();
    const LensProblem problem = views.Problem(15, 0);
    const auto found = SolveLens(problem, {});

    ASSERT_TRUE(found);
    EXPECT_TRUE(std::ranges::any_of(
        problem.views, [&](const SeenCorners& view) { return std::ssize(view) < tags.count(); }));
    EXPECT_LT(found->rms_px, 1e-4);
    EXPECT_NEAR(found->model.fx_px, truth.fx_px, 1e-3);
    EXPECT_NEAR(found->model.cx_px, truth.cx_px, 1e-3);
}

TEST_P(LensTest, NoiseOfThreeTenthsOfAPixelMovesFocalLengthAndCentreLittle) {
    const CameraModel truth = GetParam();
    const Board large{.columns = 14, .rows = 9, .square_m = 0.04};
    const auto found =
        SolveLens(BoardViews(truth, large, 2).Problem(100, kNoise_px), {.covariance = true});

    ASSERT_TRUE(found && found->covariance);
    EXPECT_LT(2 * std::sqrt((*found->covariance)(0, 0)), 0.001 * truth.fx_px);
    EXPECT_LT(2 * std::sqrt((*found->covariance)(2, 2)), 0.5);
    EXPECT_NEAR(found->model.fx_px, truth.fx_px, 0.001 * truth.fx_px);
    EXPECT_NEAR(found->model.fy_px, truth.fy_px, 0.001 * truth.fy_px);
    EXPECT_NEAR(found->model.cx_px, truth.cx_px, 0.5);
    EXPECT_NEAR(found->model.cy_px, truth.cy_px, 0.5);
}

std::array<double, 9> ParametersOf(const CameraModel& m) {
    return {m.fx_px,         m.fy_px,         m.cx_px,         m.cy_px,        m.distortion[0],
            m.distortion[1], m.distortion[2], m.distortion[3], m.distortion[4]};
}

TEST_P(LensTest, TheIntervalsHoldTheTruthAsOftenAsTheySay) {
    constexpr int kRuns = 100;
    const CameraModel truth = GetParam();
    const auto expected = ParametersOf(truth);
    std::array<int, 9> held{};
    const LensSolution start{.model = truth, .board_m = kBoard.Corners()};
    for (unsigned run = 0; run < kRuns; ++run) {
        const LensProblem problem = BoardViews(truth, kBoard, 100 + run).Problem(12, kNoise_px);
        const auto found = SolveLensFrom(start, problem, {.covariance = true});
        ASSERT_TRUE(found && found->covariance);
        const auto got = ParametersOf(found->model);
        for (int i = 0; i < found->covariance->rows(); ++i) {
            const auto at = static_cast<std::size_t>(i);
            const double sigma = std::sqrt((*found->covariance)(i, i));
            if (std::abs(got[at] - expected[at]) <= 1.96 * sigma) ++held[at];
        }
    }
    const std::size_t count = truth.kind == CameraModel::Kind::kPinholeRadtan ? 9 : 8;
    for (std::size_t i = 0; i < count; ++i) EXPECT_GE(held[i], 90) << "parameter " << i;
}

TEST_P(LensTest, ABoardThatIsNotFlatIsMeasured) {
    BoardViews views(GetParam(), kBoard, 3);
    views.Bulge(0.006);
    const LensProblem problem = views.Problem(30, 0.1);
    const auto flat = SolveLens(problem, {});
    const auto measured = SolveLens(problem, {.shape = BoardShape::kMeasured});

    ASSERT_TRUE(flat && measured);
    EXPECT_GT(flat->rms_px, 3 * measured->rms_px);
    EXPECT_LT(measured->rms_px, 0.15);
    EXPECT_NEAR(measured->model.fx_px, GetParam().fx_px, 0.003 * GetParam().fx_px);
}

INSTANTIATE_TEST_SUITE_P(Lenses, LensTest,
                         testing::Values(tests::FisheyeLens(), tests::PinholeLens()),
                         [](const auto& lens) {
                             return lens.param.kind == CameraModel::Kind::kPinholeRadtan
                                        ? "Pinhole"
                                        : "Fisheye";
                         });

struct OpenCvPoints {
    explicit OpenCvPoints(const LensProblem& problem) {
        for (const SeenCorners& view : problem.views) {
            board.emplace_back();
            corners.emplace_back();
            for (int i = 0; i < problem.board.count(); ++i) {
                const auto at = problem.board.Corner(i);
                board.back().emplace_back(at.x(), at.y(), 0);
                corners.back().emplace_back(view[static_cast<std::size_t>(i)].at_px.x(),
                                            view[static_cast<std::size_t>(i)].at_px.y());
            }
        }
    }
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> corners;
};

TEST(LensOracleTest, ErrorsAreNotAboveThoseOfOpenCvForTheSameCorners) {
    const LensProblem problem = BoardViews(tests::PinholeLens(), kBoard, 4).Problem(15, kNoise_px);
    const OpenCvPoints points(problem);
    cv::Mat camera;
    cv::Mat distortion;
    std::vector<cv::Mat> rotations;
    std::vector<cv::Mat> translations;
    const double opencv_px =
        cv::calibrateCamera(points.board, points.corners, {problem.width_px, problem.height_px},
                            camera, distortion, rotations, translations);

    const auto found = SolveLens(problem, {});

    ASSERT_TRUE(found);
    EXPECT_LE(found->rms_px, opencv_px + 1e-5);
    EXPECT_NEAR(found->model.fx_px, camera.at<double>(0, 0), 0.05);
}

TEST(LensOracleTest, ErrorsAreNotAboveThoseOfOpenCvsFisheyeForTheSameCorners) {
    const LensProblem problem = BoardViews(tests::FisheyeLens(), kBoard, 5).Problem(15, kNoise_px);
    const OpenCvPoints points(problem);
    cv::Mat camera = (cv::Mat_<double>(3, 3) << 600, 0, 640, 0, 600, 360, 0, 0, 1);
    cv::Mat distortion = cv::Mat::zeros(4, 1, CV_64F);
    const double opencv_px = cv::fisheye::calibrate(
        points.board, points.corners, {problem.width_px, problem.height_px}, camera, distortion,
        cv::noArray(), cv::noArray(),
        cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW |
            cv::fisheye::CALIB_USE_INTRINSIC_GUESS);

    const auto found = SolveLens(problem, {});

    ASSERT_TRUE(found);
    EXPECT_LE(found->rms_px, opencv_px + 1e-5);
}

/// Corners in the order of a board that was turned by 180 degrees.
SeenCorners TurnedOver(SeenCorners corners) {
    std::ranges::reverse(corners);
    for (int i = 0; i < std::ssize(corners); ++i) corners[static_cast<std::size_t>(i)].index = i;
    return corners;
}

TEST(ViewSelectionTest, ABoardThatWasTurnedIsTurnedBack) {
    BoardViews views(tests::FisheyeLens(), kBoard, 6);
    views.Bulge(0.008);
    LensProblem problem = views.Problem(16, 0.1);
    const LensProblem straight = problem;
    for (const std::size_t i : {2U, 5U, 11U}) problem.views[i] = TurnedOver(problem.views[i]);

    for (int round = 0; round < 4; ++round) {
        const auto found = SolveLens(problem, {.shape = BoardShape::kMeasured, .robust = true});
        ASSERT_TRUE(found);
        if (!TurnViewsAlike(*found, problem)) break;
    }

    for (std::size_t i = 0; i < problem.views.size(); ++i)
        EXPECT_EQ(problem.views[i], straight.views[i]) << i;
}

TEST(ViewSelectionTest, AViewOfSomethingElseIsLeftOut) {
    LensProblem problem = BoardViews(tests::FisheyeLens(), kBoard, 7).Problem(15, kNoise_px);
    for (std::size_t i = 0; i < problem.views[4].size(); ++i)
        problem.views[4][i].at_px.x() += i % 2 == 0 ? 6 : -6;
    const auto robust = SolveLens(problem, {.robust = true});

    ASSERT_TRUE(robust);
    EXPECT_EQ(OutlierViews(*robust), std::vector<std::size_t>{4});
}

TEST(ViewSelectionTest, PicturesThatAreOneGetOneNumber) {
    LensProblem problem = BoardViews(tests::FisheyeLens(), kBoard, 8).Problem(3, kNoise_px);
    problem.views.push_back(problem.views[1]);

    EXPECT_EQ(DistinctViews(problem), (std::vector<int>{0, 1, 2, 1}));
}

LensPictures PicturesOf(const LensProblem& problem) {
    LensPictures pictures{problem.kind, problem.width_px, problem.height_px, problem.board, {}};
    for (const SeenCorners& corners : problem.views)
        pictures.views.push_back({.name = "view", .corners = corners, .blur_px = 0.6});
    return pictures;
}

bool Says(const Intrinsics& lens, const std::string& what) {
    return std::ranges::any_of(
        lens.reasons, [&](const auto& reason) { return reason.find(what) != reason.npos; });
}

TEST(IntrinsicsTest, GoodViewsPass) {
    const LensProblem problem = BoardViews(tests::FisheyeLens(), kBoard, 9).Problem(25, kNoise_px);
    const auto lens = MeasureIntrinsics(PicturesOf(problem));

    ASSERT_TRUE(lens);
    EXPECT_EQ(lens->verdict, Verdict::kPass) << (lens->reasons.empty() ? "" : lens->reasons[0]);
    EXPECT_EQ(lens->shape, BoardShape::kFlat);
    ASSERT_TRUE(lens->heldout_rms_px);
    EXPECT_NEAR(*lens->heldout_rms_px, std::sqrt(2.0) * kNoise_px, 0.05);
}

TEST(IntrinsicsTest, ASmearedViewAndOneWithFewCornersAreLeftOut) {
    const LensProblem problem = BoardViews(tests::FisheyeLens(), kBoard, 9).Problem(15, kNoise_px);
    LensPictures pictures = PicturesOf(problem);
    pictures.views[3].blur_px = 1.9;
    pictures.views[8].corners.resize(9);  // one row
    const auto lens = MeasureIntrinsics(pictures);

    ASSERT_TRUE(lens);
    EXPECT_EQ(lens->views[3].fate, ViewOutcome::Fate::kSmeared);
    EXPECT_EQ(lens->views[8].fate, ViewOutcome::Fate::kFewCorners);
    EXPECT_EQ(std::ranges::count_if(lens->views, &ViewOutcome::is_used), 13);
}

TEST(IntrinsicsTest, ACameraOutOfFocusFails) {
    const LensProblem problem = BoardViews(tests::FisheyeLens(), kBoard, 9).Problem(15, kNoise_px);
    LensPictures pictures = PicturesOf(problem);
    for (BoardView& view : pictures.views) view.blur_px = 2.6;
    const auto lens = MeasureIntrinsics(pictures);

    ASSERT_TRUE(lens);
    EXPECT_EQ(lens->verdict, Verdict::kFail);
    EXPECT_TRUE(Says(*lens, "smeared over 2.6 px"));
}

TEST(IntrinsicsTest, FewViewsFail) {
    const LensProblem problem = BoardViews(tests::FisheyeLens(), kBoard, 10).Problem(4, kNoise_px);
    const auto lens = MeasureIntrinsics(PicturesOf(problem));

    ASSERT_TRUE(lens);
    EXPECT_EQ(lens->verdict, Verdict::kFail);
    EXPECT_TRUE(Says(*lens, "only 4 views"));
}

TEST(IntrinsicsTest, BoardsThatAllFaceThePinholeCameraFail) {
    BoardViews views(tests::PinholeLens(), kBoard, 11);
    views.SetMostTilt(0.02);
    const LensProblem problem = views.Problem(15, kNoise_px);
    const auto lens = MeasureIntrinsics(PicturesOf(problem));

    ASSERT_TRUE(lens);
    EXPECT_EQ(lens->verdict, Verdict::kFail);
    EXPECT_TRUE(Says(*lens, "all boards face the camera"));
}

TEST(BoardTest, ADescriptionIsReadOrRefused) {
    const ParsedBoard good = ParseBoard("9x6,0.025");
    ASSERT_TRUE(good.board);
    EXPECT_EQ(good.board->columns, 9);
    EXPECT_EQ(good.board->rows, 6);
    EXPECT_EQ(good.board->square_m, 0.025);
    for (const char* bad : {"", "9", "9x6", "9x6,", "9x6,0", "2x6,0.1", "9x6,0.025m", "9 x6,0.1"})
        EXPECT_NE(ParseBoard(bad).error.find("COLSxROWS,SQUARE_M"), std::string::npos) << bad;
}

}  // namespace
}  // namespace hitchview::calib
