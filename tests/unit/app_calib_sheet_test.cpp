#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "app/calib_sheet.hpp"
#include "app/calib_target_verb.hpp"
#include "calib/board_detector.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using calib::Pattern;
using testing::HasSubstr;

/// The sheet on a screen.
cv::Mat1b Picture(const SheetPlan& plan, double px_per_mm) {
    cv::Mat4b canvas(static_cast<int>(std::lround(px_per_mm * plan.paper_mm.y())),
                     static_cast<int>(std::lround(px_per_mm * plan.paper_mm.x())));
    cairo_surface_t* surface = cairo_image_surface_create_for_data(
        canvas.data, CAIRO_FORMAT_RGB24, canvas.cols, canvas.rows, static_cast<int>(canvas.step));
    cairo_t* cairo = cairo_create(surface);
    cairo_scale(cairo, px_per_mm, px_per_mm);
    DrawSheet(cairo, plan);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    cv::Mat1b grey;
    cv::cvtColor(canvas, grey, cv::COLOR_BGRA2GRAY);
    return grey;
}

class SheetTest : public testing::TestWithParam<Pattern> {};

TEST_P(SheetTest, ItsBoardIsFoundWhereItWasDrawnAtItsSize) {
    for (const char* paper : {"a4", "a2", "300x500"}) {
        const auto plan = PlanSheet({.pattern = GetParam(), .first_tag = 30, .paper = paper});
        ASSERT_TRUE(plan) << plan.error();
        const calib::Board& board = plan.value().board;
        const double px_per_mm = 1200 / plan.value().paper_mm.maxCoeff();
        const calib::SeenCorners seen =
            calib::DetectBoards(Picture(plan.value(), px_per_mm), {&board, 1}).front();

        EXPECT_EQ(std::ssize(seen), board.count()) << paper;
        const Eigen::Vector2d origin_mm =
            plan.value().pattern_mm - 1000 * calib::PatternArea(board).from_m;
        for (const calib::SeenCorner& corner : seen) {
            const Eigen::Vector2d drawn_px =
                px_per_mm * (origin_mm + 1000 * board.Corner(corner.index).head<2>());
            EXPECT_LT((corner.at_px + Eigen::Vector2d(0.5, 0.5) - drawn_px).norm(), 0.3);
        }
    }
}

TEST_P(SheetTest, TheMeasuringBarIs100MmLong) {
    const auto plan = PlanSheet({.pattern = GetParam(), .paper = "a4"});
    ASSERT_TRUE(plan) << plan.error();
    const cv::Mat1b picture = Picture(plan.value(), 10);
    const int row = static_cast<int>(10 * plan.value().footer_mm.y() + 5);

    EXPECT_EQ(cv::countNonZero(picture.row(row).colRange(0, 1150) < 128), 1000);
}

TEST_P(SheetTest, ADefaultBoardFillsThePaper) {
    for (const char* paper : {"a4", "a0"}) {
        const auto plan = PlanSheet({.pattern = GetParam(), .paper = paper});
        ASSERT_TRUE(plan) << plan.error();
        const Eigen::Array2d share = 1000 *
                                     calib::PatternArea(plan.value().board).size_m().array() /
                                     plan.value().paper_mm.array();
        EXPECT_GT(share.minCoeff(), 0.55) << paper;
        EXPECT_LT(share.maxCoeff(), 1) << paper;
    }
}

INSTANTIATE_TEST_SUITE_P(Patterns, SheetTest,
                         testing::Values(Pattern::kCheckerboard, Pattern::kCharuco,
                                         Pattern::kTags));

TEST(SheetPlanTest, WhatDoesNotFitIsRefusedWithTheLargestSquareThatWould) {
    SheetRequest request{
        .pattern = Pattern::kCharuco, .columns = 9, .rows = 6, .square_m = 0.04, .paper = "a4"};
    const std::string error = PlanSheet(request).error();
    const std::string before = "--square-m may be at most ";
    ASSERT_THAT(error, HasSubstr(before));

    const double largest_m = std::stod(error.substr(error.find(before) + before.size()));
    request.square_m = largest_m;
    EXPECT_TRUE(PlanSheet(request));
    request.square_m = largest_m + 0.0002;
    EXPECT_FALSE(PlanSheet(request));
}

TEST(SheetPlanTest, WrongNumbersAreNamed) {
    EXPECT_THAT(PlanSheet({.paper = "letter"}).error(), HasSubstr("--paper is letter"));
    EXPECT_THAT(PlanSheet({.columns = 2}).error(), HasSubstr("--columns"));
    EXPECT_THAT(PlanSheet({.square_m = 0.03, .tag_m = 0.03}).error(), HasSubstr("--tag-m"));
    EXPECT_THAT(PlanSheet({.first_tag = 580}).error(), HasSubstr("--first-tag must be 0 to "));
}

TEST(SheetFileTest, PagesHaveTheSizeOfThePaper) {
    const auto plan = PlanSheet({.paper = "a3"});
    ASSERT_TRUE(plan);

    EXPECT_THAT(SheetFile(plan.value(), SheetFormat::kPdf).value().bytes,
                HasSubstr("/MediaBox [ 0 0 1190.55"));
    const std::string svg = SheetFile(plan.value(), SheetFormat::kSvg).value().bytes;
    EXPECT_THAT(svg, HasSubstr("width=\"420mm\" height=\"297mm\" viewBox=\"0 0 420 297\""));
}

TEST(TargetVerbTest, SheetAndBoardFileAreWritten) {
    const tests::TemporaryFolder folder;
    TargetOptions options;
    options.sheet.pattern = Pattern::kTags;
    options.out = folder.path() + "/sheet.pdf";
    options.board_out = folder.path() + "/board.yaml";

    EXPECT_EQ(TargetVerb(options), 0);
    EXPECT_GT(std::filesystem::file_size(options.out), 1000U);
    EXPECT_TRUE(calib::LoadBoard(options.board_out).board);
    options.out = folder.path() + "/sheet.png";
    EXPECT_EQ(TargetVerb(options), 2);
    options.out = folder.path() + "/none/sheet.pdf";
    EXPECT_EQ(TargetVerb(options), 3);
}

}  // namespace
}  // namespace hitchview::app
