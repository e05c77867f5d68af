#include <gtest/gtest.h>

#include <cmath>

#include "algo/articulation.hpp"
#include "tests/support/hinged_rig.hpp"

namespace hitchview::algo {
namespace {

using tests::HingedScene;
using tests::kDegree;
using Inter = PerOverlap<InterFeatures>;

Eigen::Matrix3d Yawed(double yaw_rad) {
    return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// Errors of many independent estimates.
struct Errors {
    double squares = 0;
    double squares_of_sigmas = 0;  ///< error over reported deviation
    int known = 0;
    int unknown = 0;

    void Add(const std::optional<Articulation>& estimate, double yaw_rad) {
        if (!estimate) {
            ++unknown;
            return;
        }
        const double error = estimate->angle_rad - yaw_rad;
        squares += error * error;
        squares_of_sigmas += error * error / (estimate->sigma_rad * estimate->sigma_rad);
        ++known;
    }
    [[nodiscard]] double RmsDegrees() const { return std::sqrt(squares / known) / kDegree; }
};

class ArticulationTest : public testing::Test {
 protected:
    ArticulationEstimator Estimator(const ArticulationOptions& options = {}) const {
        return {rig_[Unit::kTractor], rig_[Unit::kTrailer], options};
    }

    /// Single frame sets over the whole range of the hinge, each seen by a new estimator.
    Errors OverTheRange(const HingedScene::Options& scene_options, int inliers,
                        const ArticulationOptions& options = {}) const {
        Errors errors;
        for (int yaw_deg = -65; yaw_deg <= 65; yaw_deg += 2) {
            for (unsigned seed = 0; seed < 3; ++seed) {
                HingedScene scene(rig_, scene_options, 7 * static_cast<unsigned>(yaw_deg) + seed);
                const double yaw_rad = yaw_deg * kDegree;
                errors.Add(Estimator(options).Step({}, scene.See(yaw_rad, inliers)), yaw_rad);
            }
        }
        return errors;
    }

    const PerUnit<UnitGeometry> rig_ = tests::HingedRig();
};

TEST_F(ArticulationTest, ThirtyMatchesGiveTheAngleFromNothingOverTheWholeRange) {
    const Errors errors = OverTheRange({}, 30);
    EXPECT_LT(errors.RmsDegrees(), 0.4);
    EXPECT_LE(errors.unknown, errors.known / 50);
}

TEST_F(ArticulationTest, MoreMatchesGiveABetterAngle) {
    EXPECT_LT(OverTheRange({}, 150).RmsDegrees(), 0.6 * OverTheRange({}, 30).RmsDegrees());
}

TEST_F(ArticulationTest, HalfOfTheMatchesMayBeWrong) {
    const Errors errors = OverTheRange({.outlier_share = 0.5}, 60);
    EXPECT_LT(errors.RmsDegrees(), 0.4);
    EXPECT_LE(errors.unknown, errors.known / 50);
}

TEST_F(ArticulationTest, TheDeviationIsTheTrueOne) {
    const ArticulationOptions exact{.systematic_rad = 0};
    for (const int inliers : {30, 150}) {
        for (const double noise_px : {0.3, 1.0}) {
            const Errors errors = OverTheRange({.noise_px = noise_px}, inliers, exact);
            EXPECT_GT(errors.squares_of_sigmas / errors.known, 0.4) << inliers << ' ' << noise_px;
            EXPECT_LT(errors.squares_of_sigmas / errors.known, 1.6) << inliers << ' ' << noise_px;
        }
    }
}

TEST_F(ArticulationTest, AFarSceneAboveTheHorizonTellsTheAngle) {
    const Errors errors =
        OverTheRange({.nearest_m = 1000, .farthest_m = 3000, .highest_m = 400}, 60);
    EXPECT_LT(errors.RmsDegrees(), 0.5);
    EXPECT_LE(errors.unknown, errors.known / 20);
}

// There every epipolar plane is level and stays so when the trailer turns.
TEST_F(ArticulationTest, ASceneOnTheHorizonTellsNothingAndNothingIsReported) {
    const Errors errors = OverTheRange(
        {.nearest_m = 1000, .farthest_m = 3000, .lowest_m = 1.6, .highest_m = 1.8, .play_rad = 0},
        60);
    EXPECT_EQ(errors.known, 0);
}

TEST_F(ArticulationTest, TooFewMatchesTellNothing) {
    EXPECT_EQ(OverTheRange({.outlier_share = 0}, 14).known, 0);
    EXPECT_FALSE(Estimator().Step({}, {}));
}

TEST_F(ArticulationTest, OneMatchManyTimesTellsNothing) {
    HingedScene scene(rig_, {}, 3);
    const InterFeature one = scene.See(0.2, 1)[Overlap::kLeft].empty()
                                 ? scene.See(0.2, 40)[Overlap::kLeft][0]
                                 : scene.See(0.2, 40)[Overlap::kRight][0];
    Inter features;
    for (int i = 0; i < 100; ++i) features[Overlap::kLeft].push_back(one);
    EXPECT_FALSE(Estimator().Step({}, features));
}

TEST_F(ArticulationTest, WrongMatchesAloneTellNothing) {
    for (unsigned seed = 1; seed < 20; ++seed) {
        HingedScene scene(rig_, {.outlier_share = 0.98}, seed);
        EXPECT_FALSE(Estimator().Step({}, scene.See(0.3, 6))) << seed;
    }
}

TEST_F(ArticulationTest, SameMatchesSameAngle) {
    HingedScene scene(rig_, {}, 5);
    const Inter features = scene.See(-0.4, 50);
    const auto first = Estimator().Step({}, features);
    const auto second = Estimator().Step({}, features);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->angle_rad, second->angle_rad);
    EXPECT_EQ(first->sigma_rad, second->sigma_rad);
}

/// A trailer that swings between -60 and 60 degrees at up to 20 degrees/s, and shakes.
class ArticulatedDriveTest : public ArticulationTest {
 protected:
    static double YawAt(int frame) {
        return 60 * kDegree * std::sin(frame / 90.0) + 0.6 * kDegree * std::sin(1.3 * frame);
    }
    /// The tractor turns, too; the views tell the turns with some noise.
    static PerUnit<IntraMotion> IntraAt(int frame) {
        const double tractor = 0.01;
        const double trailer = tractor + YawAt(frame) - YawAt(frame - 1);
        PerUnit<IntraMotion> intra;
        intra[Unit::kTractor].M_late_early = Yawed(-tractor + 0.002 * std::sin(2.1 * frame));
        intra[Unit::kTrailer].M_late_early = Yawed(-trailer);
        intra[Unit::kTractor].known = intra[Unit::kTrailer].known = true;
        return intra;
    }
};

TEST_F(ArticulatedDriveTest, TheAngleIsFollowed) {
    ArticulationEstimator sut = Estimator();
    HingedScene scene(rig_, {}, 1);
    Errors errors;
    for (int frame = 0; frame < 600; ++frame) {
        errors.Add(sut.Step(IntraAt(frame), scene.See(YawAt(frame), 30)), YawAt(frame));
    }
    EXPECT_EQ(errors.unknown, 0);
    EXPECT_LT(errors.RmsDegrees(), 0.3);
}

TEST_F(ArticulatedDriveTest, WithoutMatchesTheAngleIsPredictedUntilItIsTooUncertain) {
    ArticulationEstimator sut = Estimator();
    HingedScene scene(rig_, {}, 1);
    ASSERT_TRUE(sut.Step({}, scene.See(YawAt(0), 60)));
    double sigma_rad = 0;
    int frame = 1;
    for (; frame < 200; ++frame) {
        const auto predicted = sut.Step(IntraAt(frame), {});
        if (!predicted) break;
        EXPECT_EQ(predicted->inliers, 0);
        EXPECT_GT(predicted->sigma_rad, sigma_rad);
        EXPECT_LT(std::abs(predicted->angle_rad - YawAt(frame)), 4 * predicted->sigma_rad);
        sigma_rad = predicted->sigma_rad;
    }
    EXPECT_GT(frame, 10);
    EXPECT_LT(frame, 100);
    const auto again = sut.Step(IntraAt(frame), scene.See(YawAt(frame), 60));
    ASSERT_TRUE(again);
    EXPECT_NEAR(again->angle_rad, YawAt(frame), 1 * kDegree);
}

TEST_F(ArticulatedDriveTest, AJumpThatThePredictionMissedIsFoundAgain) {
    ArticulationEstimator sut = Estimator();
    HingedScene scene(rig_, {}, 2);
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(sut.Step({}, scene.See(-0.5, 60)));
    std::optional<Articulation> found;
    for (int i = 0; i < 60; ++i) found = sut.Step({}, scene.See(0.4, 60));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->angle_rad, 0.4, 1 * kDegree);
}

TEST_F(ArticulatedDriveTest, ResetForgetsTheAngle) {
    ArticulationEstimator sut = Estimator();
    HingedScene scene(rig_, {}, 2);
    ASSERT_TRUE(sut.Step({}, scene.See(0.1, 60)));
    EXPECT_TRUE(sut.Step({}, {}));
    sut.Reset();
    EXPECT_FALSE(sut.Step({}, {}));
}

}  // namespace
}  // namespace hitchview::algo
