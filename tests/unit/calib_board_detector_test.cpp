#include <gtest/gtest.h>

#include "calib/board_detector.hpp"
#include "tests/support/board_scene.hpp"

namespace hitchview::calib {
namespace {

using algo::CameraModel;
using Eigen::Vector2d;
using tests::BoardScene;
using tests::BoardSceneOptions;
using tests::Held;
using tests::PlacedBoard;

constexpr double kDegree = 3.14159265358979 / 180;

const Board kCheckerboard{.columns = 9, .rows = 6, .square_m = 0.06};
const Board kCharuco{
    .columns = 9, .rows = 6, .square_m = 0.06, .pattern = Pattern::kCharuco, .tag_m = 0.042};
const Board kTagGrid{.columns = 6,
                     .rows = 4,
                     .square_m = 0.1,
                     .pattern = Pattern::kTags,
                     .tag_m = 0.077,
                     .first_tag = 100};

CameraModel Pinhole() {
    return {.kind = CameraModel::Kind::kPinholeRadtan,
            .width_px = 960,
            .height_px = 600,
            .fx_px = 560,
            .fy_px = 562,
            .cx_px = 482,
            .cy_px = 297,
            .distortion = {-0.2, 0.05},
            .max_theta_rad = 0.85};
}

CameraModel Fisheye(double across_deg) {
    const double half_rad = across_deg / 2 * kDegree;
    const double f_px = 480 / (half_rad * (1 - 0.02 * half_rad * half_rad));
    return {.kind = CameraModel::Kind::kKannalaBrandt4,
            .width_px = 960,
            .height_px = 600,
            .fx_px = f_px,
            .fy_px = f_px,
            .cx_px = 482,
            .cy_px = 297,
            .distortion = {-0.02},
            .max_theta_rad = std::min(1.15 * half_rad, 3.0)};
}

/// How corners that were found differ from where the lens puts them.
struct Errors {
    double sum_px2 = 0;
    int seen = 0;

    [[nodiscard]] double rms_px() const { return std::sqrt(sum_px2 / seen); }
    void Add(const SeenCorners& corners, const CameraModel& lens, const PlacedBoard& board) {
        for (const SeenCorner& corner : corners) {
            const auto truth = lens.Project(board.T_world_board * board.board.Corner(corner.index));
            sum_px2 += truth ? (*truth - corner.at_px).squaredNorm() : 1e6;
            ++seen;
        }
    }
};

SeenCorners Detect(const cv::Mat& grey, const Board& board) {
    return DetectBoards(grey, {&board, 1}).front();
}

class DetectionTest : public testing::TestWithParam<std::tuple<Board, CameraModel>> {
 protected:
    /// Of the board held all over the picture, tilted to all sides.
    [[nodiscard]] Errors ErrorsIn(const BoardSceneOptions& options) const {
        const auto& [board, lens] = GetParam();
        const BoardScene scene(lens);
        const bool wide = lens.kind == CameraModel::Kind::kKannalaBrandt4;
        const double distance_m = wide ? 0.7 : 0.9;
        Errors errors;
        for (const Vector2d& at : {Vector2d(480, 300), {280, 190}, {680, 390}, {480, 200}}) {
            const double tilt_rad = 0.6 * std::sin(at.x());
            const PlacedBoard placed{board,
                                     Held(lens, board, at, distance_m, tilt_rad, at.y(), 0.2)};
            const cv::Mat1b picture =
                scene.Render(Eigen::Isometry3d::Identity(), {&placed, 1}, options);
            errors.Add(Detect(picture, board), lens, placed);
        }
        return errors;
    }
    [[nodiscard]] int corners() const { return 4 * std::get<0>(GetParam()).count(); }
};

TEST_P(DetectionTest, CornersLieWhereTheLensPutsThem) {
    const Errors errors = ErrorsIn({});

    EXPECT_GE(errors.seen, 0.85 * corners());
    EXPECT_LE(errors.rms_px(), 0.1);
}

TEST_P(DetectionTest, NoiseAndBlurMoveThemLittle) {
    const Errors errors = ErrorsIn({.blur_px = 0.8, .noise_grey = 3});

    EXPECT_GE(errors.seen, 0.7 * corners());
    EXPECT_LE(errors.rms_px(), 0.2);
}

std::string NameOf(const testing::TestParamInfo<DetectionTest::ParamType>& info) {
    const auto& [board, lens] = info.param;
    const char* const patterns[] = {"Checkerboard", "Charuco", "Tags"};
    const int across_deg = static_cast<int>(std::lround(2 * lens.max_theta_rad / 1.15 / kDegree));
    return std::string(patterns[static_cast<int>(board.pattern)]) +
           (lens.kind == CameraModel::Kind::kPinholeRadtan
                ? "ThroughAPinhole"
                : "Through" + std::to_string(across_deg) + "Degrees");
}

INSTANTIATE_TEST_SUITE_P(Boards, DetectionTest,
                         testing::Combine(testing::Values(kCheckerboard, kCharuco, kTagGrid),
                                          testing::Values(Pinhole(), Fisheye(120), Fisheye(155),
                                                          Fisheye(190))),
                         NameOf);

class PartTest : public testing::TestWithParam<Board> {};

TEST_P(PartTest, WhatIsHiddenIsNotFoundAndTheRestIs) {
    const CameraModel lens = Fisheye(155);
    const PlacedBoard placed{GetParam(), Held(lens, GetParam(), {480, 300}, 0.5, 0.3, 1)};
    cv::Mat1b picture = BoardScene(lens).Render(Eigen::Isometry3d::Identity(), {&placed, 1});
    const cv::Rect hand(300, 250, 160, 350);
    picture(hand).setTo(130);
    const SeenCorners corners = Detect(picture, GetParam());

    Errors errors;
    errors.Add(corners, lens, placed);
    EXPECT_GE(errors.seen, GetParam().count() / 2);
    EXPECT_LE(errors.rms_px(), 0.15);
    for (const SeenCorner& corner : corners)
        EXPECT_FALSE(hand.contains(cv::Point(cv::Point2d(corner.at_px.x(), corner.at_px.y()))));
}

TEST_P(PartTest, ABoardThatReachesBeyondThePictureIsFoundInPart) {
    const CameraModel lens = Fisheye(155);
    const PlacedBoard placed{GetParam(), Held(lens, GetParam(), {60, 300}, 0.5)};
    const SeenCorners corners =
        Detect(BoardScene(lens).Render(Eigen::Isometry3d::Identity(), {&placed, 1}), GetParam());

    Errors errors;
    errors.Add(corners, lens, placed);
    EXPECT_GE(errors.seen, GetParam().count() / 5);
    EXPECT_LT(errors.seen, GetParam().count());
    EXPECT_LE(errors.rms_px(), 0.15);
}

INSTANTIATE_TEST_SUITE_P(Boards, PartTest, testing::Values(kCharuco, kTagGrid));

TEST(BoardDetectorTest, TwoBoardsInOnePictureAreToldApart) {
    const CameraModel lens = Fisheye(155);
    const std::vector<PlacedBoard> placed{
        {kCharuco, Held(lens, kCharuco, {250, 300}, 0.9, 0.3, 1)},
        {kTagGrid, Held(lens, kTagGrid, {720, 300}, 0.9, -0.4, 1)}};
    const cv::Mat1b picture = BoardScene(lens).Render(Eigen::Isometry3d::Identity(), placed);
    const auto seen = DetectBoards(picture, std::vector{kCharuco, kTagGrid, kCheckerboard});

    ASSERT_EQ(seen.size(), 3U);
    for (std::size_t i = 0; i < 2; ++i) {
        Errors errors;
        errors.Add(seen[i], lens, placed[i]);
        EXPECT_GE(errors.seen, 0.8 * placed[i].board.count());
        EXPECT_LE(errors.rms_px(), 0.15);
    }
}

/// A picture of `shown` in which `asked` is looked for.
SeenCorners Mistaken(const Board& shown, const Board& asked) {
    const CameraModel lens = Fisheye(120);
    const PlacedBoard placed{shown, Held(lens, shown, {480, 300}, 0.6)};
    return Detect(BoardScene(lens).Render(Eigen::Isometry3d::Identity(), {&placed, 1}), asked);
}

TEST(BoardDetectorTest, AnotherBoardIsNotFound) {
    Board other_tags = kTagGrid;
    other_tags.first_tag = 300;
    EXPECT_TRUE(Mistaken(kTagGrid, other_tags).empty());
    Board other_grid = kTagGrid;
    std::swap(other_grid.columns, other_grid.rows);
    EXPECT_TRUE(Mistaken(kTagGrid, other_grid).empty());
    Board charuco_of_its_tags = kCharuco;
    charuco_of_its_tags.first_tag = kTagGrid.first_tag;
    EXPECT_TRUE(Mistaken(kTagGrid, charuco_of_its_tags).empty());
    EXPECT_TRUE(Mistaken(kCheckerboard, kCharuco).empty());
}

TEST(BoardDetectorTest, ATagThatIsSeenTwiceIsNotTrusted) {
    const CameraModel lens = Fisheye(155);
    const std::vector<PlacedBoard> placed{{kTagGrid, Held(lens, kTagGrid, {250, 300}, 0.9)},
                                          {kTagGrid, Held(lens, kTagGrid, {720, 300}, 0.9)}};
    const cv::Mat1b picture = BoardScene(lens).Render(Eigen::Isometry3d::Identity(), placed);

    EXPECT_TRUE(Detect(picture, kTagGrid).empty());
}

TEST(BoardDetectorTest, NothingIsFoundWhereNoBoardIs) {
    const cv::Mat1b picture =
        BoardScene(Fisheye(155))
            .Render(Eigen::Isometry3d::Identity(), {}, {.noise_grey = 10, .seed = 3});

    for (const SeenCorners& seen :
         DetectBoards(picture, std::vector{kCheckerboard, kCharuco, kTagGrid}))
        EXPECT_TRUE(seen.empty());
}

TEST(BoardDetectorTest, APictureWithoutRoomHasNoBoard) {
    const std::vector boards{kCheckerboard, kCharuco, kTagGrid};
    for (const cv::Size& size : {cv::Size(0, 0), cv::Size(1, 400), cv::Size(31, 31)})
        EXPECT_EQ(DetectBoards(cv::Mat1b(size, 200), boards), std::vector<SeenCorners>(3));
}

TEST(BoardDetectorTest, APartOfALargerPictureIsLookedAtAlone) {
    const CameraModel lens = Fisheye(155);
    const PlacedBoard placed{kTagGrid, Held(lens, kTagGrid, {480, 300}, 0.7)};
    const cv::Mat1b picture = BoardScene(lens).Render(Eigen::Isometry3d::Identity(), {&placed, 1});
    const cv::Rect part(200, 100, 500, 400);
    const SeenCorners alone = Detect(picture(part).clone(), kTagGrid);

    EXPECT_GT(alone.size(), 60U);
    EXPECT_EQ(Detect(picture(part), kTagGrid), alone);
}

}  // namespace
}  // namespace hitchview::calib
