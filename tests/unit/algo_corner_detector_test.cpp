#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <set>

#include "algo/corner_detector.hpp"
#include "tests/support/test_pictures.hpp"

namespace hitchview::algo {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 200;

cv::Mat1b Textured() {
    return tests::Texture({kWidth, kHeight}, 7);
}

struct Detection {
    explicit Detection(const CornerDetectorOptions& options = {})
        : detector(kWidth, kHeight, options) {}

    const CornerDetector::Corners& Run(const cv::Mat1b& image, int wanted,
                                       const cv::Mat1b& mask = {},
                                       std::span<const Eigen::Vector2f> taken = {}) {
        detector.Detect(image, mask, taken, wanted, corners);
        return corners;
    }

    CornerDetector detector;
    CornerDetector::Corners corners;
};

float ChebyshevDistance(const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

TEST(CornerDetectorTest, StrengthIsTheSmallerEigenvalueThatOpenCvFinds) {
    Detection detection;
    const cv::Mat1b image = Textured();
    detection.Run(image, 10);

    cv::Mat1f oracle;
    cv::cornerMinEigenVal(image, oracle, 5, 3);
    // OpenCV: Sobel sums over grey 0..1 and 4 x 5 px; here mean of squared slopes of grey levels.
    oracle *= 255.0 * 255.0 / 4;
    const cv::Rect interior(4, 4, kWidth - 8, kHeight - 8);
    double strongest;
    cv::minMaxLoc(oracle, nullptr, &strongest);
    EXPECT_LT(cv::norm(detection.detector.strength()(interior), oracle(interior), cv::NORM_INF),
              1e-4 * strongest);
}

TEST(CornerDetectorTest, TheCornersOfADarkSquareAreFoundWhereTheyAre) {
    cv::Mat1b image(kHeight, kWidth, std::uint8_t{200});
    image(cv::Rect(100, 60, 80, 70)).setTo(40);
    Detection detection;
    const auto& corners = detection.Run(image, 50);
    ASSERT_EQ(corners.count(), 4);
    for (const Corner& corner : corners) {
        const float x = std::min(std::abs(corner.position_px.x() - 99.5F),
                                 std::abs(corner.position_px.x() - 179.5F));
        const float y = std::min(std::abs(corner.position_px.y() - 59.5F),
                                 std::abs(corner.position_px.y() - 129.5F));
        EXPECT_LT(std::max(x, y), 2.6F) << corner.position_px.transpose();
    }
}

TEST(CornerDetectorTest, CornersSpreadOverThePictureThoughOneSideIsMuchStronger) {
    cv::Mat1b image = Textured();
    cv::Mat1b weak = image(cv::Rect(kWidth / 2, 0, kWidth / 2, kHeight));
    weak.convertTo(weak, CV_8U, 0.35, 80);
    Detection detection;
    const auto& corners = detection.Run(image, 120);
    ASSERT_EQ(corners.count(), 120);
    std::set<int> buckets;
    int on_weak_side = 0;
    for (const Corner& corner : corners) {
        const auto col = static_cast<int>(corner.position_px.x()) * 16 / kWidth;
        const auto row = static_cast<int>(corner.position_px.y()) * 8 / kHeight;
        buckets.insert(row * 16 + col);
        on_weak_side += col >= 8 ? 1 : 0;
    }
    EXPECT_GT(buckets.size(), 100U);
    EXPECT_GT(on_weak_side, 35);
}

TEST(CornerDetectorTest, NoTwoCornersAreCloserThanTheMinimumDistance) {
    Detection detection({.min_distance_px = 11});
    const auto& corners = detection.Run(Textured(), 500);
    ASSERT_GT(corners.count(), 60);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            EXPECT_GT(ChebyshevDistance(corners[i].position_px, corners[k].position_px), 11.0F);
        }
    }
}

TEST(CornerDetectorTest, NoCornerLiesNearATakenPlace) {
    Detection detection;
    const CornerDetector::Corners first = detection.Run(Textured(), 80);
    std::vector<Eigen::Vector2f> taken;
    for (const Corner& corner : first) taken.push_back(corner.position_px);
    taken.emplace_back(-50.0F, 1e4F);  // outside the picture: blocks nothing
    const auto& second = detection.Run(Textured(), 300, {}, taken);
    ASSERT_GT(second.count(), 50);
    for (const Corner& corner : second) {
        for (const Eigen::Vector2f& place : taken) {
            EXPECT_GT(ChebyshevDistance(corner.position_px, place), 7.0F);
        }
    }
}

TEST(CornerDetectorTest, CornersLieOnlyWhereTheMaskAllowsThemAndOffTheBorder) {
    cv::Mat1b mask(kHeight, kWidth, std::uint8_t{0});
    cv::circle(mask, {150, 100}, 70, {255}, cv::FILLED);
    Detection detection({.border_px = 40});
    const auto& corners = detection.Run(Textured(), 300, mask);
    ASSERT_GT(corners.count(), 20);
    for (const Corner& corner : corners) {
        const cv::Point at(static_cast<int>(corner.position_px.x()),
                           static_cast<int>(corner.position_px.y()));
        EXPECT_NE(mask(at), 0) << at;
        EXPECT_TRUE(cv::Rect(40, 40, kWidth - 80, kHeight - 80).contains(at)) << at;
    }
}

TEST(CornerDetectorTest, NeverMoreCornersThanWantedOrThanFit) {
    Detection detection({.min_strength = 0.01F, .quality = 0, .min_distance_px = 0});
    for (const int wanted : {0, 1, 17, 5000}) {
        const int found = detection.Run(Textured(), wanted).count();
        EXPECT_LE(found, std::min(wanted, CornerDetector::kMaxCorners));
        EXPECT_TRUE(found == wanted || wanted > 17) << wanted << " wanted, found " << found;
    }
}

TEST(CornerDetectorTest, APictureWithoutTextureHasNoCorners) {
    Detection detection;
    EXPECT_EQ(detection.Run(cv::Mat1b(kHeight, kWidth, std::uint8_t{90}), 100).count(), 0);
    cv::Mat1b edge(kHeight, kWidth, std::uint8_t{20});
    edge(cv::Rect(160, 0, 160, kHeight)).setTo(220);
    EXPECT_EQ(detection.Run(edge, 100).count(), 0) << "a straight edge is no corner";
}

TEST(CornerDetectorTest, TheSamePictureGivesTheSameCornersAgain) {
    Detection detection;
    const CornerDetector::Corners first = detection.Run(Textured(), 100);
    detection.Run(tests::Texture({kWidth, kHeight}, 8), 100);
    const auto& again = detection.Run(Textured(), 100);
    ASSERT_EQ(first.count(), again.count());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].position_px, again[i].position_px);
    }
}

}  // namespace
}  // namespace hitchview::algo
