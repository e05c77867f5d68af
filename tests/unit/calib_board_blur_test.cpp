#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "calib/board_blur.hpp"

namespace hitchview::calib {
namespace {

constexpr Board kBoard{.columns = 7, .rows = 5, .square_m = 0.04};
constexpr int kSquare_px = 32;

/// A board that faces the camera, its first corner at (64, 64) of pixels' edges.
cv::Mat1b Picture(double sigma_x_px, double sigma_y_px) {
    cv::Mat1b picture((kBoard.rows + 3) * kSquare_px, (kBoard.columns + 3) * kSquare_px, 220);
    for (int row = 0; row <= kBoard.rows; ++row) {
        for (int column = 0; column <= kBoard.columns; ++column) {
            const cv::Rect square((column + 1) * kSquare_px, (row + 1) * kSquare_px, kSquare_px,
                                  kSquare_px);
            if ((row + column) % 2 == 0) picture(square).setTo(40);
        }
    }
    if (sigma_x_px > 0)
        cv::GaussianBlur(picture, picture, {31, 31}, sigma_x_px, std::max(sigma_y_px, 0.01));
    return picture;
}

SeenCorners Seen() {
    SeenCorners corners;
    for (int i = 0; i < kBoard.count(); ++i) {
        corners.push_back({i,
                           {(i % kBoard.columns + 2) * kSquare_px - 0.5,
                            (i / kBoard.columns + 2) * kSquare_px - 0.5}});
    }
    return corners;
}

TEST(BoardBlurTest, IsTheStandardDeviationOfTheBlur) {
    for (const double sigma_px : {1.0, 1.5, 2.0, 3.0}) {
        const auto blur_px = BoardBlur_px(Picture(sigma_px, sigma_px), kBoard, Seen());
        ASSERT_TRUE(blur_px);
        EXPECT_NEAR(*blur_px, sigma_px, 0.1 * sigma_px);
    }
}

TEST(BoardBlurTest, ASharpPictureHasLittle) {
    const auto blur_px = BoardBlur_px(Picture(0, 0), kBoard, Seen());
    ASSERT_TRUE(blur_px);
    EXPECT_LT(*blur_px, 0.5);
}

TEST(BoardBlurTest, AMovingBoardIsAsSmearedAsInItsDirection) {
    const auto blur_px = BoardBlur_px(Picture(2.5, 0.5), kBoard, Seen());
    ASSERT_TRUE(blur_px);
    EXPECT_NEAR(*blur_px, 2.5, 0.25);
}

TEST(BoardBlurTest, IsUnknownWithoutAStep) {
    const cv::Mat1b grey(300, 400, 128);
    EXPECT_FALSE(BoardBlur_px(grey, kBoard, Seen()));
    EXPECT_FALSE(BoardBlur_px(Picture(1, 1), kBoard, {}));
}

}  // namespace
}  // namespace hitchview::calib
