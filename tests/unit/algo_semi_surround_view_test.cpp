#include <gtest/gtest.h>

#include "algo/semi_surround_view.hpp"
#include "tests/support/nv12_picture.hpp"
#include "tests/support/small_ring.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::algo {
namespace {

using tests::Nv12Picture;

constexpr int kWidth = 160;
constexpr int kHeight = 120;

cv::Mat1b Compose(SemiSurroundView& view, const UnitFrames& frames) {
    cv::Mat1b picture(view.height_px(), view.width_px(), std::uint8_t{99});
    view.Compose(frames, picture);
    return picture;
}

TEST(SemiSurroundViewTest, APlaneAtFullSizeIsTheLumaPlane) {
    const UnitGeometry geometry = UnitGeometry::Plane(kWidth, kHeight);
    SemiSurroundView view(geometry, 1);
    const cv::Mat1b luma = tests::Texture({kWidth, kHeight}, 3);
    const Nv12Picture picture(luma);
    const cv::Mat1b composed = Compose(view, {picture.frame()});
    ASSERT_EQ(composed.size(), luma.size());
    const cv::Rect inner(0, 0, kWidth - 1,
                         kHeight - 1);  // the rest has no right or lower neighbour
    EXPECT_EQ(cv::norm(composed(inner), luma(inner), cv::NORM_INF), 0);
    EXPECT_NE(view.mask()(kHeight / 2, kWidth / 2), 0);
}

TEST(SemiSurroundViewTest, APlaneAtHalfSizeIsTheMeanOfFourPixels) {
    const UnitGeometry geometry = UnitGeometry::Plane(kWidth, kHeight);
    SemiSurroundView view(geometry, 0.5);
    const cv::Mat1b luma = tests::Texture({kWidth, kHeight}, 4);
    const Nv12Picture picture(luma);
    const cv::Mat1b composed = Compose(view, {picture.frame()});
    ASSERT_EQ(composed.size(), cv::Size(kWidth / 2, kHeight / 2));
    for (int y = 0; y < composed.rows - 1; ++y) {
        for (int x = 0; x < composed.cols - 1; ++x) {
            const int sum = luma(2 * y, 2 * x) + luma(2 * y, 2 * x + 1) + luma(2 * y + 1, 2 * x) +
                            luma(2 * y + 1, 2 * x + 1);
            ASSERT_NEAR(composed(y, x), sum / 4.0, 0.51) << x << ' ' << y;
        }
    }
}

TEST(SemiSurroundViewTest, PixelsOfTheViewAndOfTheAnalysisConvertIntoEachOther) {
    const UnitGeometry geometry = UnitGeometry::Plane(kWidth, kHeight);
    const SemiSurroundView view(geometry, 0.5);
    EXPECT_LT((view.ToView({10, 20}) - Eigen::Vector2d{20.5, 40.5}).norm(), 1e-9);
    const Eigen::Vector2f at{13.25F, 40.5F};
    EXPECT_LT((view.ToAnalysis(view.ToView(at)) - at).norm(), 1e-5F);
}

TEST(SemiSurroundViewTest, APlaneWithoutItsPictureIsBlackAndMaskedUntilThePictureIsBack) {
    const UnitGeometry geometry = UnitGeometry::Plane(kWidth, kHeight);
    SemiSurroundView view(geometry, 1);
    EXPECT_EQ(cv::countNonZero(Compose(view, {})), 0);
    EXPECT_EQ(cv::countNonZero(view.mask()), 0);
    const Nv12Picture picture(cv::Mat1b(kHeight, kWidth, std::uint8_t{77}));
    EXPECT_EQ(Compose(view, {picture.frame()})(60, 80), 77);
    EXPECT_GT(cv::countNonZero(view.mask()), kWidth * kHeight / 2);
}

class RingViewTest : public testing::Test {
 protected:
    static constexpr std::array<std::uint8_t, 3> kGrey{60, 120, 180};
    UnitFrames Frames() const {
        UnitFrames frames;
        for (std::size_t i = 0; i < 3; ++i) frames[i] = pictures_[i].frame();
        return frames;
    }

    Projection view_ = Projection::Cylinder(1024, 160, 0.5);
    UnitGeometry geometry_ = UnitGeometry::Ring(view_, tests::LevelCameras(3, 1.2, 0), {});
    SemiSurroundView surround_{geometry_, 0.5};
    std::vector<Nv12Picture> pictures_{Nv12Picture(cv::Mat1b(200, 320, kGrey[0])),
                                       Nv12Picture(cv::Mat1b(200, 320, kGrey[1])),
                                       Nv12Picture(cv::Mat1b(200, 320, kGrey[2]))};
};

TEST_F(RingViewTest, EveryPixelComesFromTheCameraWithTheLargestShareAndNothingIsBlended) {
    const cv::Mat1b composed = Compose(surround_, Frames());
    UnitGeometry::Sights sights;
    int seen = 0;
    for (int y = 0; y < composed.rows; y += 3) {
        for (int x = 0; x < composed.cols; ++x) {
            const int grey = composed(y, x);
            if (grey == 0) continue;
            ++seen;
            geometry_.See(
                view_.Ray(surround_.ToView({static_cast<float>(x), static_cast<float>(y)})),
                sights);
            const auto best =
                std::max_element(sights.begin(), sights.end(),
                                 [](const auto& a, const auto& b) { return a.weight < b.weight; });
            ASSERT_NE(best, sights.end());
            ASSERT_EQ(grey, kGrey[static_cast<std::size_t>(best->camera)]) << x << ' ' << y;
        }
    }
    EXPECT_GT(seen, 1000);
}

TEST_F(RingViewTest, NoFeatureMayLieNearAJointOrTheEdgeOfTheView) {
    const cv::Mat1b composed = Compose(surround_, Frames());
    const cv::Mat1b& mask = surround_.mask();
    int allowed = 0;
    for (int y = 6; y < mask.rows - 6; ++y) {
        for (int x = 6; x < mask.cols - 6; ++x) {
            if (mask(y, x) == 0) continue;
            ++allowed;
            const cv::Mat1b around = composed(cv::Rect(x - 6, y - 6, 13, 13));
            ASSERT_EQ(cv::countNonZero(around == composed(y, x)), 13 * 13) << x << ' ' << y;
        }
    }
    EXPECT_GT(allowed, 1000);
}

TEST_F(RingViewTest, AMissingCamerasPartIsBlackAndMaskedAndTheOthersStay) {
    const cv::Mat1b all = Compose(surround_, Frames());
    UnitFrames frames = Frames();
    frames[1] = {};
    const cv::Mat1b two = Compose(surround_, frames);
    for (int y = 0; y < all.rows; ++y) {
        for (int x = 0; x < all.cols; ++x) {
            const bool missing = all(y, x) == kGrey[1];
            ASSERT_EQ(two(y, x), missing ? 0 : all(y, x));
            ASSERT_TRUE(!missing || surround_.mask()(y, x) == 0);
        }
    }
    EXPECT_GT(cv::countNonZero(surround_.mask()), 1000);
}

}  // namespace
}  // namespace hitchview::algo
