#include <gtest/gtest.h>

#include <cmath>

#include "algo/match_refinement.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

constexpr int kWidth = 120;
constexpr int kHeight = 80;
const cv::Size kSize{kWidth, kHeight};

/// Refined matches of a grid of pixels, all `start_px` off where they are.
template <typename Visitor>
void RefineAll(const cv::Mat1b& from, const cv::Mat1b& to, const Vector2f& start_px,
               const Visitor& visit) {
    for (int y = 16; y < kHeight - 16; y += 6) {
        for (int x = 16; x < kWidth - 16; x += 6) {
            Vector2f found = Vector2f(static_cast<float>(x), static_cast<float>(y)) + start_px;
            const float told = RefineMatch(from, x, y, to, found);
            visit(Vector2f(found.x() - static_cast<float>(x), found.y() - static_cast<float>(y)),
                  told);
        }
    }
}

TEST(MatchRefinementTest, HalfAPixelOffItComesToAFifthWhateverTheExposure) {
    const tests::SineTexture world(3, 6, 24);
    const cv::Mat1b from = world.Shifted(kSize, 0, 0);
    const Vector2f shift(3.37F, -1.28F);
    const cv::Mat1b to = world.Shifted(kSize, shift.x(), shift.y());
    for (const cv::Mat1b& shown : {to, cv::Mat1b(0.6 * to + 40)}) {
        int near = 0;
        int all = 0;
        RefineAll(from, shown, {3, -1}, [&](const Vector2f& found, float told) {
            ++all;
            if ((found - shift).norm() < 0.2F) ++near;
            EXPECT_GT(told, 0.5F);
        });
        EXPECT_GT(near, 0.95 * all) << all;
    }
}

TEST(MatchRefinementTest, WhatShowsNothingStaysWhereItIsAndTellsNothing) {
    const cv::Mat1b grey(kSize, std::uint8_t{120});
    RefineAll(grey, grey, {0.4F, -0.3F}, [](const Vector2f& found, float told) {
        EXPECT_EQ(told, 0);
        EXPECT_LT((found - Vector2f(0.4F, -0.3F)).norm(), 1e-4F);
    });
}

TEST(MatchRefinementTest, LevelStripesMoveItUpAndDownAlone) {
    const auto stripes = [](double down_px) {
        cv::Mat1b picture(kSize);
        for (int y = 0; y < kHeight; ++y)
            picture.row(y).setTo(128 + 90 * std::sin(0.9 * (y - down_px)));
        return picture;
    };
    RefineAll(stripes(0), stripes(0.6), {0.5F, 0}, [](const Vector2f& found, float told) {
        EXPECT_EQ(told, 0) << "nothing is known of x";
        EXPECT_NEAR(found.x(), 0.5, 1e-4);
        EXPECT_NEAR(found.y(), 0.6, 0.15);
    });
}

TEST(MatchRefinementTest, AMatchThatWouldGoFarStaysAndTellsNothing) {
    const tests::SineTexture world(5, 9, 40);
    const cv::Mat1b from = world.Shifted(kSize, 0, 0);
    const cv::Mat1b to = world.Shifted(kSize, 4, 3);
    int stayed = 0;
    RefineAll(from, to, {0, 0}, [&](const Vector2f& found, float told) {
        EXPECT_LE(found.norm(), 2);
        if (told > 0) return;
        ++stayed;
        EXPECT_EQ(found.norm(), 0);
    });
    EXPECT_GT(stayed, 20);
}

TEST(MatchRefinementTest, APatchThatLeavesItsPictureTellsNothing) {
    const cv::Mat1b picture = tests::SineTexture(7).Shifted(kSize, 0, 0);
    const auto told = [&](int x, int y, Vector2f found) {
        const Vector2f before = found;
        const float result = RefineMatch(picture, x, y, picture, found);
        EXPECT_TRUE(result > 0 || found == before);
        return result;
    };
    EXPECT_GT(told(4, 4, {4, 4}), 0);
    EXPECT_EQ(told(3, 40, {60, 40}), 0);
    EXPECT_EQ(told(60, kHeight - 4, {60, 40}), 0);
    EXPECT_EQ(told(60, 40, {3.9F, 40}), 0);
    EXPECT_EQ(told(60, 40, {60, static_cast<float>(kHeight) - 3.5F}), 0);
    EXPECT_EQ(told(60, 40, {-50, 900}), 0);
}

}  // namespace
}  // namespace hitchview::algo
