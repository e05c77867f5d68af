#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "calib/angle_fit.hpp"

namespace hitchview::calib {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFactor = 1.05;
constexpr double kOffset_rad = -1.5 * kDegree;

/// Ten pairs a second of a drive that swings to both sides; a sensor that is wrong by factor and
/// offset, images with noise of half a degree, and now and then something else entirely.
std::vector<AnglePair> Drive(double seconds, double most_rad, unsigned seed, double wrong = 0) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.5 * kDegree);
    std::uniform_real_distribution<double> u(0, 1);
    std::vector<AnglePair> pairs;
    // Each second its own error, as that of an estimate that changes slowly.
    double error_rad = 0;
    for (int i = 0; i < 10 * seconds; ++i) {
        if (i % 10 == 0) error_rad = u(random) < wrong ? 0.4 : noise(random);
        const double time_s = 0.1 * i;
        const double swing = std::sin(time_s / 9);
        const double truth_rad = most_rad * swing * swing * swing;
        pairs.push_back({time_s, (truth_rad - kOffset_rad) / kFactor, truth_rad + error_rad});
    }
    return pairs;
}

TEST(AngleFitTest, FindsFactorAndOffsetOfTheSensor) {
    const auto fit = FitAngles(Drive(120, 0.6, 1, 0.1));
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->factor, kFactor, 0.01);
    EXPECT_NEAR(fit->offset_rad, kOffset_rad, 0.2 * kDegree);
    EXPECT_NEAR(fit->scatter_rad, 0.5 * kDegree, 0.25 * kDegree);
    EXPECT_THAT(JudgeAngles(*fit), IsEmpty());
}

TEST(AngleFitTest, TheIntervalsHoldTheTruthAsOftenAsTheySay) {
    constexpr int kRuns = 200;
    int factors = 0;
    int offsets = 0;
    for (unsigned run = 0; run < kRuns; ++run) {
        const auto fit = FitAngles(Drive(90, 0.5, 10 + run));
        ASSERT_TRUE(fit);
        factors += std::abs(fit->factor - kFactor) <= 1.96 * fit->factor_sigma ? 1 : 0;
        offsets += std::abs(fit->offset_rad - kOffset_rad) <= 1.96 * fit->offset_sigma_rad ? 1 : 0;
    }
    EXPECT_GE(factors, 0.9 * kRuns);
    EXPECT_GE(offsets, 0.9 * kRuns);
}

TEST(AngleFitTest, SaysThatThereIsNoTurn) {
    const auto fit = FitAngles(Drive(120, 0.05, 2));
    ASSERT_TRUE(fit);
    EXPECT_THAT(JudgeAngles(*fit), Contains(HasSubstr("the drive has no turn")));
}

TEST(AngleFitTest, SaysThatItIsNeverStraight) {
    std::vector<AnglePair> pairs = Drive(120, 0.6, 3);
    std::erase_if(pairs, [](const AnglePair& pair) { return std::abs(pair.image_rad) < 0.1; });
    const auto fit = FitAngles(pairs);
    ASSERT_TRUE(fit);
    EXPECT_THAT(JudgeAngles(*fit), Contains(HasSubstr("the drive is straight for 0 s only")));
}

TEST(AngleFitTest, HasNoAnswerForAMomentOrForOneAngle) {
    EXPECT_FALSE(FitAngles(Drive(4, 0.6, 4)));
    EXPECT_FALSE(FitAngles(Drive(100, 0, 5)));
    EXPECT_FALSE(FitAngles({}));
}

}  // namespace
}  // namespace hitchview::calib
