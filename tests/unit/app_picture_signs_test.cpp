#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "app/picture_signs.hpp"

namespace hitchview::app {
namespace {

using hal::CameraState;

constexpr int kCols = 160;
constexpr int kRows = 120;

/// Noise round a grey level, always the same; `contrast`: of its grey levels.
std::vector<std::uint8_t> PictureOf(double contrast, int mean) {
    std::mt19937 dice(7);
    std::uniform_real_distribution<double> level(-40, 40);
    std::vector<std::uint8_t> luma(static_cast<std::size_t>(kCols * kRows));
    for (std::uint8_t& pixel : luma)
        pixel = static_cast<std::uint8_t>(mean + contrast * level(dice));
    return luma;
}

algo::CameraFrame FrameOf(const std::vector<std::uint8_t>& luma) {
    algo::CameraFrame frame{.width_px = kCols, .height_px = kRows};
    frame.luma = luma.data();
    frame.luma_stride_bytes = kCols;
    frame.layout = algo::PixelLayout::kGrey;
    return frame;
}

class PictureSignsTest : public testing::Test {
 protected:
    using Found = std::array<CameraSigns, kMaxCameras>;

    /// What is found after so many sets in which the cameras' detail, squared grey levels, is these
    /// shares of that of a picture of this contrast.
    Found After(int sets, const std::vector<double>& shares, double contrast = 1) {
        Found found{};
        for (int set = 0; set < sets; ++set) {
            const int mean = 120 + set % 2;  // no picture repeats the one before
            found = {};
            signs_.Begin();
            for (std::size_t i = 0; i < shares.size(); ++i)
                signs_.Add(i, FrameOf(PictureOf(contrast * std::sqrt(shares[i]), mean)));
            signs_.Finish(found);
        }
        return found;
    }

    /// Of one camera whose detail is this share of what three others have.
    bool IsDirtyAfter(int sets, double share, double contrast = 1) {
        const Found found = After(sets, {1, share, 1, 1}, contrast);
        EXPECT_FALSE(found[0][CameraState::kDirty]);
        return found[1][CameraState::kDirty];
    }

    static constexpr int kUntilForgotten = 60;  // sets, then nothing of the past is left
    PictureSigns signs_;
};

TEST_F(PictureSignsTest, DetailIsLostBelowOneShareAndFoundAboveAnother) {
    EXPECT_FALSE(IsDirtyAfter(kUntilForgotten, 0.16));
    EXPECT_TRUE(IsDirtyAfter(kUntilForgotten, 0.11));
    EXPECT_TRUE(IsDirtyAfter(kUntilForgotten, 0.16)) << "the scene makes it come and go";
    EXPECT_FALSE(IsDirtyAfter(2, 0.25));
    EXPECT_FALSE(IsDirtyAfter(kUntilForgotten, 0.16));
}

TEST_F(PictureSignsTest, WhatWasRichForAWhileIsNotDirtyWhenItIsAsTheOthers) {
    constexpr double kSoft = 0.5;
    EXPECT_FALSE(IsDirtyAfter(5 * kUntilForgotten, 25, kSoft));
    EXPECT_FALSE(IsDirtyAfter(5 * kUntilForgotten, 1, kSoft));
}

TEST_F(PictureSignsTest, ADirtyCameraDoesNotHideTheDirtOfAnother) {
    const double soft = 0.5;
    const double dirty = 0.11;  // too much to be blurred
    After(kUntilForgotten, {1, 1, soft, 1, 1});
    Found found = After(kUntilForgotten, {dirty, 1, soft, 1, 1});
    EXPECT_TRUE(found[0][CameraState::kDirty]);
    found = After(kUntilForgotten, {dirty, dirty, soft, 1, 1});
    EXPECT_TRUE(found[1][CameraState::kDirty]) << "of all five, the soft one is the middle";
    EXPECT_FALSE(found[2][CameraState::kDirty]);
    found = After(kUntilForgotten, {1, 1, soft, 1, 1});
    for (std::size_t i = 0; i < 5; ++i) EXPECT_FALSE(found[i][CameraState::kDirty]) << i;
}

TEST_F(PictureSignsTest, WhatMostCamerasLackIsTheScenes) {
    const double plain = 0.11;  // too much to be blurred
    After(kUntilForgotten, {1, 1, 1, 1, 1, 1, 1});
    Found found = After(kUntilForgotten, {plain, plain, 1, 1, 1, 1, 1});
    EXPECT_TRUE(found[0][CameraState::kDirty]);
    found = After(kUntilForgotten, {plain, plain, plain, plain, 1, 1, 1});
    for (std::size_t i = 0; i < 7; ++i) EXPECT_FALSE(found[i][CameraState::kDirty]) << i;
}

}  // namespace
}  // namespace hitchview::app
