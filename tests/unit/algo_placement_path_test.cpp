#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "algo/placement_path.hpp"
#include "tests/support/shaky_profiles.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;

constexpr int kFrames = 90;
constexpr int kRadius = 10;

/// A placement that turns steadily, with noise of matching on it.
std::vector<PlacementSample> Turning(const Projection& view, double noise_px) {
    cv::RNG random(4);
    std::vector<PlacementSample> samples;
    for (int i = 0; i < kFrames; ++i) {
        const Eigen::Vector3d value{100 + 1.5 * i + random.gaussian(noise_px),
                                    random.gaussian(noise_px / 400), 0.0005 * i};
        samples.push_back({ToPose(view, {value}), 1.0});
    }
    return samples;
}

double ShiftOf(const Projection& view, const Matrix3d& pose) {
    return ToOffset(view, pose).value.x();
}

class PlacementPathTest : public testing::TestWithParam<Projection> {
 protected:
    const Projection view_ = GetParam();
};

TEST_P(PlacementPathTest, WithoutSmoothingPlacementsStay) {
    const auto samples = Turning(view_, 1);
    const auto found = SmoothPlacements(view_, samples, 0, kRadius);
    ASSERT_EQ(found.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
        EXPECT_LT((found[i] - samples[i].pose).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_P(PlacementPathTest, NoiseIsReducedAndTheTurnStays) {
    const auto samples = Turning(view_, 1);
    const auto found = SmoothPlacements(view_, samples, 0.3, kRadius);
    Eigen::VectorXd raw(kFrames);
    Eigen::VectorXd smooth(kFrames);
    for (int i = 0; i < kFrames; ++i) {
        raw(i) = ShiftOf(view_, samples[static_cast<std::size_t>(i)].pose);
        smooth(i) = ShiftOf(view_, found[static_cast<std::size_t>(i)]);
    }
    EXPECT_LT(tests::Jitter(smooth), 0.35 * tests::Jitter(raw));
    EXPECT_NEAR(smooth(kFrames / 2), 100 + 1.5 * kFrames / 2, 1);
}

TEST_P(PlacementPathTest, FramesWithoutAPlacementAreBridged) {
    auto samples = Turning(view_, 0);
    for (std::size_t i = 40; i < 55; ++i) samples[i] = {};
    samples[0] = {};
    const auto found = SmoothPlacements(view_, samples, 0.3, kRadius);
    for (const int i : {40, 47, 54})
        EXPECT_NEAR(ShiftOf(view_, found[static_cast<std::size_t>(i)]), 100 + 1.5 * i, 2) << i;
}

TEST_P(PlacementPathTest, WithoutAnyPlacementThereIsNone) {
    EXPECT_TRUE(
        SmoothPlacements(view_, {PlacementSample{}, PlacementSample{}}, 0.3, kRadius).empty());
}

INSTANTIATE_TEST_SUITE_P(Projections, PlacementPathTest,
                         testing::Values(Projection::Plane(640, 360),
                                         Projection::Cylinder(1024, 180, 0.5)));

TEST(PlacementPathTest, OnAPlaneScaleIsSmoothedToo) {
    const Projection plane = Projection::Plane(640, 360);
    std::vector<PlacementSample> samples;
    for (int i = 0; i < kFrames; ++i) {
        const double scale = 1.05 + (i % 2 == 0 ? 0.01 : -0.01);
        samples.push_back({ZoomAbout({100, 50}, scale), 1.0});
    }
    const auto found = SmoothPlacements(plane, samples, 0.3, kRadius);
    EXPECT_NEAR(ScaleOf(plane, found[45]), 1.05, 0.003);
    EXPECT_NEAR(ScaleOf(plane, found[46]), 1.05, 0.003);
}

}  // namespace
}  // namespace hitchview::algo
