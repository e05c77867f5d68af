#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <opencv2/video/tracking.hpp>

#include "algo/patch_alignment.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

const cv::Size kSize(320, 240);

GreyPyramid PyramidOf(const cv::Mat1b& picture) {
    GreyPyramid pyramid(picture.cols, picture.rows);
    picture.copyTo(pyramid.base());
    pyramid.Build();
    return pyramid;
}

/// Smaller eigenvalue of the covariance of the slopes in the patch around a pixel.
float TextureStrength(const cv::Mat1b& picture, int x, int y) {
    Eigen::Array<float, 2, 15 * 15> slopes;
    int i = 0;
    for (int v = y - 7; v <= y + 7; ++v) {
        for (int u = x - 7; u <= x + 7; ++u, ++i) {
            slopes(0, i) = 0.5F * static_cast<float>(picture(v, u + 1) - picture(v, u - 1));
            slopes(1, i) = 0.5F * static_cast<float>(picture(v + 1, u) - picture(v - 1, u));
        }
    }
    slopes.colwise() -= slopes.rowwise().mean().eval();
    const Eigen::Matrix2f covariance = slopes.matrix() * slopes.matrix().transpose() / 225.0F;
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(covariance).eigenvalues()(0);
}

/// Points of a grid where a patch has texture in both directions.
std::vector<Vector2f> TexturedPoints(const cv::Mat1b& picture, int margin_px, int step_px) {
    constexpr float kGood = 8;  // grey levels^2 / px^2
    std::vector<Vector2f> points;
    for (int y = margin_px; y < picture.rows - margin_px; y += step_px) {
        for (int x = margin_px; x < picture.cols - margin_px; x += step_px) {
            if (TextureStrength(picture, x, y) < kGood) continue;
            points.emplace_back(static_cast<float>(x), static_cast<float>(y));
        }
    }
    return points;
}

struct Errors {
    float rms = 0;
    float worst = 0;
};

/// Distances from the truth over all textured points; every one must be found.
Errors Measure(const GreyPyramid& from, const GreyPyramid& to, const Vector2f& shift,
               const Vector2f& guessed_shift, int coarsest, int margin_px) {
    Errors errors;
    const std::vector<Vector2f> points = TexturedPoints(from.level(0), margin_px, 19);
    EXPECT_GT(points.size(), 12U);
    for (const Vector2f& point : points) {
        const auto match = AlignPatch(from, to, point, point + guessed_shift, coarsest, {});
        if (!match) {
            ADD_FAILURE() << "lost at " << point.transpose();
            continue;
        }
        EXPECT_GT(match->correlation, 0.99F) << point.transpose();
        const float error = (match->position_px - point - shift).norm();
        errors.rms += error * error;
        errors.worst = std::max(errors.worst, error);
    }
    errors.rms = std::sqrt(errors.rms / static_cast<float>(points.size()));
    return errors;
}

class KnownShiftTest : public testing::TestWithParam<Vector2f> {
 protected:
    Vector2f shift_ = GetParam();
    tests::SineTexture world_{3, 16, 40};
    GreyPyramid from_ = PyramidOf(world_.Shifted(kSize, 0, 0));
    cv::Mat1b to_ = world_.Shifted(kSize, shift_.x(), shift_.y());
};

TEST_P(KnownShiftTest, IsFoundToAFiftiethOfAPixel) {
    const Errors errors = Measure(from_, PyramidOf(to_), shift_, Vector2f::Zero(), 0, 20);
    EXPECT_LT(errors.rms, 0.02F);
    EXPECT_LT(errors.worst, 0.06F);
}

TEST_P(KnownShiftTest, IsFoundThoughThePicturesDifferInBrightnessAndContrast) {
    to_.convertTo(to_, CV_8U, 0.6, 20);
    const Errors errors = Measure(from_, PyramidOf(to_), shift_, Vector2f::Zero(), 0, 20);
    EXPECT_LT(errors.rms, 0.03F);  // fewer grey levels
    EXPECT_LT(errors.worst, 0.1F);
}

INSTANTIATE_TEST_SUITE_P(Shifts, KnownShiftTest,
                         testing::Values(Vector2f{0, 0}, Vector2f{0.5F, 0.5F},
                                         Vector2f{0.25F, -0.7F}, Vector2f{-1.3F, 0.9F},
                                         Vector2f{2.0F, -1.0F}));

TEST(PatchAlignmentTest, ThePyramidReachesShiftsThatThePatchAloneDoesNot) {
    const Vector2f shift{13.4F, -9.3F};
    const tests::SineTexture world(5, 22, 160);
    const GreyPyramid from = PyramidOf(world.Shifted({480, 400}, 0, 0));
    const GreyPyramid to = PyramidOf(world.Shifted({480, 400}, shift.x(), shift.y()));
    int found = 0;
    int found_without = 0;
    const std::vector<Vector2f> points = TexturedPoints(from.level(0), 70, 9);
    const auto right = [&](const Vector2f& point, int coarsest) {
        const auto match = AlignPatch(from, to, point, point, coarsest, {});
        return match && (match->position_px - point - shift).norm() < 0.1F ? 1 : 0;
    };
    for (const Vector2f& point : points) {
        found += right(point, 2);
        found_without += right(point, 0);
    }
    const auto count = static_cast<double>(points.size());
    EXPECT_GT(count, 12);
    EXPECT_GT(found, 0.8 * count);
    EXPECT_LT(found_without, 0.2 * count);
}

TEST(PatchAlignmentTest, AGuessTakesThePlaceOfThePyramid) {
    const Vector2f shift{40.3F, 12.6F};
    const tests::SineTexture world(6, 14, 42);
    const GreyPyramid from = PyramidOf(world.Shifted(kSize, 0, 0));
    const GreyPyramid to = PyramidOf(world.Shifted(kSize, shift.x(), shift.y()));
    EXPECT_LT(Measure(from, to, shift, {39.5F, 13.5F}, 0, 55).rms, 0.02F);
}

TEST(PatchAlignmentTest, IsAtLeastAsAccurateAsOpenCvsPyramidalLucasKanade) {
    const tests::SineTexture world(8);
    const Vector2f shift{5.37F, -3.81F};
    const cv::Mat1b early = world.Shifted(kSize, 0, 0);
    const cv::Mat1b late = world.Shifted(kSize, shift.x(), shift.y());
    const std::vector<Vector2f> points = TexturedPoints(early, 40, 17);

    std::vector<cv::Point2f> from;
    for (const Vector2f& p : points) from.emplace_back(p.x(), p.y());
    std::vector<cv::Point2f> to;
    std::vector<std::uint8_t> status;
    cv::calcOpticalFlowPyrLK(early, late, from, to, status, cv::noArray(), {15, 15}, 2);

    const GreyPyramid early_pyramid = PyramidOf(early);
    const GreyPyramid late_pyramid = PyramidOf(late);
    double ours = 0;
    double theirs = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto match = AlignPatch(early_pyramid, late_pyramid, points[i], points[i], 2, {});
        ASSERT_TRUE(match) << points[i].transpose();
        ASSERT_NE(status[i], 0);
        ours += (match->position_px - points[i] - shift).squaredNorm();
        theirs += (Vector2f{to[i].x, to[i].y} - points[i] - shift).squaredNorm();
    }
    EXPECT_LE(ours, theirs);
}

TEST(PatchAlignmentTest, APatchWithoutTextureInBothDirectionsIsRefused) {
    const GreyPyramid flat = PyramidOf(cv::Mat1b(kSize, std::uint8_t{100}));
    EXPECT_FALSE(AlignPatch(flat, flat, {100, 100}, {100, 100}, 2, {}));
    cv::Mat1b stripes(kSize);
    for (int x = 0; x < kSize.width; ++x) {
        stripes.col(x).setTo(cv::saturate_cast<std::uint8_t>(128 + 100 * std::sin(0.4 * x)));
    }
    const GreyPyramid striped = PyramidOf(stripes);
    EXPECT_FALSE(AlignPatch(striped, striped, {100, 100}, {100, 100}, 0, {}));
}

TEST(PatchAlignmentTest, ATemplateMustFitIntoThePictureWithOnePixelToSpare) {
    const GreyPyramid pyramid = PyramidOf(tests::SineTexture(9).Shifted(kSize, 0, 0));
    const auto found = [&](double x, double y) {
        const Vector2f at = Eigen::Vector2d{x, y}.cast<float>();
        return AlignPatch(pyramid, pyramid, at, at, 3, {}).has_value();
    };
    EXPECT_TRUE(found(8, 8));
    EXPECT_TRUE(found(kSize.width - 10.05, kSize.height - 9.05));
    EXPECT_FALSE(found(7.9, 100));
    EXPECT_FALSE(found(100, 7.9));
    EXPECT_FALSE(found(kSize.width - 10.0, 100));
    EXPECT_FALSE(found(100, kSize.height - 9.0));
    EXPECT_FALSE(found(-100, 1e6));
}

TEST(PatchAlignmentTest, APatchThatMovedOutOfThePictureIsRefused) {
    const tests::SineTexture world(10, 24, 96);
    const GreyPyramid from = PyramidOf(world.Shifted(kSize, 0, 0));
    const GreyPyramid to = PyramidOf(world.Shifted(kSize, -8, 0));
    EXPECT_FALSE(AlignPatch(from, to, {12, 120}, {12, 120}, 0, {}));
    EXPECT_TRUE(AlignPatch(from, to, {18, 120}, {18, 120}, 0, {}));
}

TEST(PatchAlignmentTest, AMatchFartherAwayThanAllowedIsRefused) {
    const tests::SineTexture world(11, 24, 96);
    const GreyPyramid from = PyramidOf(world.Shifted(kSize, 0, 0));
    const GreyPyramid to = PyramidOf(world.Shifted(kSize, 5, 0));
    const Vector2f at = TexturedPoints(from.level(0), 60, 10).front();
    EXPECT_TRUE(AlignPatch(from, to, at, at, 0, {.max_travel_px = 6}));
    EXPECT_FALSE(AlignPatch(from, to, at, at, 0, {.max_travel_px = 4}));
}

}  // namespace
}  // namespace hitchview::algo
