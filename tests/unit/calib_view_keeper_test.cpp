#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "calib/view_keeper.hpp"
#include "tests/support/board_scene.hpp"
#include "tests/support/board_views.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;

const Board kBoard{.columns = 9, .rows = 6, .square_m = 0.06};
const CornerLook kSharp{.blur_px = 1, .dark_grey = 30, .white_grey = 220};
const ViewGoals kStills{.most_motion_px = 0};

/// Corners of the board held before the camera; those outside the picture are not seen.
SeenCorners Seen(const Vector2d& at, double distance_m, double tilt_rad = 0, double axis_rad = 0) {
    const algo::CameraModel lens = tests::FisheyeLens();
    const auto T = tests::Held(lens, kBoard, at, distance_m, tilt_rad, axis_rad);
    SeenCorners seen;
    for (int i = 0; i < kBoard.count(); ++i) {
        const auto px = lens.Project(T * kBoard.Corner(i));
        if (px && px->x() >= 0 && px->y() >= 0 && px->x() < lens.width_px &&
            px->y() < lens.height_px)
            seen.push_back({i, *px});
    }
    return seen;
}

ViewKeeper Keeper(const ViewGoals& goals) {
    return {kBoard, {1280, 720}, goals};
}

TEST(RoughPoseTest, TheSideThatIsAwayIsTold) {
    const auto tilt = [](double tilt_rad, double axis_rad) {
        return RoughPose(kBoard, Seen({640, 360}, 0.8, tilt_rad, axis_rad), {1280, 720})->tilt;
    };
    EXPECT_EQ(tilt(0, 0), Tilt::kFacing);
    EXPECT_EQ(tilt(0.6, 0), Tilt::kBottomAway);
    EXPECT_EQ(tilt(-0.6, 0), Tilt::kTopAway);
    EXPECT_EQ(tilt(0.6, 1.5708), Tilt::kLeftAway);
    EXPECT_EQ(tilt(-0.6, 1.5708), Tilt::kRightAway);
}

TEST(RoughPoseTest, NearBoardsAreLarge) {
    const auto size = [](double distance_m) {
        return RoughPose(kBoard, Seen({640, 360}, distance_m), {1280, 720})->size;
    };
    EXPECT_GT(size(0.4), 1.8 * size(0.8));
    EXPECT_NEAR(size(1.0), 0.6 * 602 / 1280, 0.03);
}

TEST(CornerLookTest, BlurAndGreysAreMeasured) {
    const algo::CameraModel lens = tests::PinholeLens();
    const tests::PlacedBoard placed{kBoard, tests::Held(lens, kBoard, {640, 360}, 0.8, 0.2, 1)};
    const tests::BoardScene scene(lens);
    SeenCorners corners;
    for (int i = 0; i < kBoard.count(); ++i)
        corners.push_back({i, *lens.Project(placed.T_world_board * kBoard.Corner(i))});
    for (const double blur_px : {1.5, 3.0}) {
        const auto look = LookAtCorners(
            scene.Render(Eigen::Isometry3d::Identity(), {&placed, 1}, {.blur_px = blur_px}),
            corners);
        ASSERT_TRUE(look);
        EXPECT_NEAR(look->blur_px, blur_px, 0.25 * blur_px);
        EXPECT_NEAR(look->white_grey, 225, 15);
        EXPECT_NEAR(look->dark_grey, 30, 15);
    }
    EXPECT_FALSE(LookAtCorners(cv::Mat1b(100, 100), {}));
}

TEST(ViewKeeperTest, AGoodViewIsKeptOnce) {
    ViewKeeper keeper = Keeper(kStills);
    const SeenCorners corners = Seen({640, 360}, 0.8);

    EXPECT_TRUE(keeper.Judge(corners, kSharp).keep);
    EXPECT_FALSE(keeper.Judge(corners, kSharp).keep);
    EXPECT_EQ(keeper.views(), 1);
    EXPECT_TRUE(keeper.Judge(Seen({240, 360}, 0.8), kSharp).keep);
}

TEST(ViewKeeperTest, WhatIsBlurredDarkOrBrightIsRefusedAndSaid) {
    ViewKeeper keeper = Keeper(kStills);
    const SeenCorners corners = Seen({640, 360}, 0.8);
    const auto advice = [&](const CornerLook& look) {
        const ViewKeeper::Answer answer = keeper.Judge(corners, look);
        EXPECT_FALSE(answer.keep);
        return answer.advice;
    };
    EXPECT_THAT(advice({.blur_px = 4, .dark_grey = 30, .white_grey = 220}), HasSubstr("blurred"));
    EXPECT_THAT(advice({.blur_px = 1, .dark_grey = 5, .white_grey = 40}), HasSubstr("too dark"));
    EXPECT_THAT(advice({.blur_px = 1, .dark_grey = 90, .white_grey = 255}),
                HasSubstr("too bright"));
    EXPECT_EQ(keeper.Judge({}, std::nullopt).advice, "show the board");
}

TEST(ViewKeeperTest, ABoardIsKeptWhenItIsHeldStill) {
    ViewKeeper keeper = Keeper({});
    EXPECT_EQ(keeper.Judge(Seen({600, 360}, 0.8), kSharp).advice, "hold still");
    EXPECT_EQ(keeper.Judge(Seen({605, 360}, 0.8), kSharp).advice, "hold still");
    EXPECT_TRUE(keeper.Judge(Seen({605.5, 360}, 0.8), kSharp).keep);
}

TEST(ViewKeeperTest, ItAsksForThePartOfThePictureThatLacksMost) {
    ViewKeeper keeper = Keeper(kStills);
    std::string advice;
    for (const Vector2d& at : {Vector2d(300, 200), {300, 400}, {300, 560}, {500, 360}})
        advice = keeper.Judge(Seen(at, 0.7), kSharp).advice;
    EXPECT_THAT(advice, HasSubstr("hold it into the "));
    EXPECT_THAT(advice, HasSubstr("right"));
}

/// A person who holds the board anywhere, at random.
void HoldAnywhere(ViewKeeper& keeper, int times, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    for (int i = 0; i < times && !keeper.enough(); ++i) {
        const double y_px = 720 * u(random);
        const double x_px = 1280 * u(random);
        const double distance_m = 0.35 + 1.0 * u(random);
        const double axis_rad = 6 * u(random);
        const double tilt_rad = 1.4 * (u(random) - 0.5);
        keeper.Judge(Seen({x_px, y_px}, distance_m, tilt_rad, axis_rad), kSharp);
    }
}

TEST(ViewKeeperTest, ItStopsWhenTheViewsAreSpreadAndNotBefore) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        ViewKeeper keeper = Keeper(kStills);
        HoldAnywhere(keeper, 300, seed);
        ASSERT_TRUE(keeper.enough()) << seed;
        EXPECT_GE(keeper.covered(), 0.75);
        EXPECT_GE(keeper.views(), 20);
        EXPECT_LE(keeper.views(), 45);
        for (const Tilt tilt :
             {Tilt::kLeftAway, Tilt::kRightAway, Tilt::kTopAway, Tilt::kBottomAway})
            EXPECT_GE(keeper.tilted(tilt), 3);
        EXPECT_GE(keeper.near(), 5);
        EXPECT_GE(keeper.far(), 3);
    }
}

TEST(ViewKeeperTest, ABoardInOnePlaceIsNeverEnough) {
    ViewKeeper keeper = Keeper(kStills);
    for (int i = 0; i < 200; ++i) keeper.Judge(Seen({640 + 0.2 * i, 360}, 0.8), kSharp);

    EXPECT_FALSE(keeper.enough());
    EXPECT_LE(keeper.views(), 2);
    EXPECT_FALSE(keeper.missing().empty());
}

}  // namespace
}  // namespace hitchview::calib
