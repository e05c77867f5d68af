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
constexpr std::size_t kCameras = 4;
constexpr std::size_t kDirty = 1;

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
    /// What one camera shows after so many sets in which its detail, squared grey levels, is this
    /// share of what the others have, whose contrast this is.
    bool IsDirtyAfter(int sets, double share, double contrast = 1) {
        std::array<CameraSigns, kMaxCameras> found{};
        for (int set = 0; set < sets; ++set) {
            const int mean = 120 + set % 2;  // no picture repeats the one before
            const std::vector<std::uint8_t> usual = PictureOf(contrast, mean);
            const std::vector<std::uint8_t> dirty =
                PictureOf(contrast * std::sqrt(share), mean);
            found = {};
            signs_.Begin();
            for (std::size_t i = 0; i < kCameras; ++i)
                signs_.Add(i, FrameOf(i == kDirty ? dirty : usual));
            signs_.Finish(found);
        }
        EXPECT_FALSE(found[0][CameraState::kDirty]);
        return found[kDirty][CameraState::kDirty];
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

}  // namespace
}  // namespace hitchview::app
