#include <gtest/gtest.h>

#include "algo/paper_stages.hpp"
#include "tests/support/shaky_profiles.hpp"

namespace hitchview::algo {
namespace {

using Eigen::VectorXd;
using tests::Jitter;
using tests::Rms;

constexpr int kFrames = 240;
constexpr double kMatchNoise_px = 0.15;

/// One scene point seen by two shaking units, while the trailer swings by 60 px at the hitch and
/// back.
struct TwoViews {
    explicit TwoViews(double kappa) {
        cv::RNG random(9);
        VectorXd gap(kFrames);  // trailer minus tractor position, as matched
        VectorXd swing(kFrames);
        for (int t = 0; t < kFrames; ++t) {
            swing(t) = 60 * std::exp(-std::pow((t - 120) / 45.0, 2));
        }
        profiles[Unit::kTractor].T = tests::ShakyPath(kFrames, 21);
        profiles[Unit::kTrailer].T = tests::ShakyPath(kFrames, 22) + swing;
        for (int t = 0; t < kFrames; ++t) {
            gap(t) = profiles[Unit::kTrailer].T(t) - profiles[Unit::kTractor].T(t) +
                     random.gaussian(kMatchNoise_px);
        }
        profiles[Unit::kTractor].V = kappa * gap;
        profiles[Unit::kTrailer].V = (kappa - 1) * gap;
        confidence = Profiles::Ones(kFrames, 1);
    }

    /// Where the point is shown by a unit.
    [[nodiscard]] VectorXd Shown(const PerUnit<OptimizedProfiles>& found, Unit unit) const {
        return profiles[unit].T + found[unit].Warp(profiles[unit].T);
    }
    [[nodiscard]] double Misalignment(const PerUnit<OptimizedProfiles>& found) const {
        return Rms(Shown(found, Unit::kTractor) - Shown(found, Unit::kTrailer));
    }
    [[nodiscard]] double ShownJitter(const PerUnit<OptimizedProfiles>& found) const {
        return Jitter(0.5 * (Shown(found, Unit::kTractor) + Shown(found, Unit::kTrailer)));
    }
    [[nodiscard]] double SeenJitter() const {
        return Jitter(0.5 * (profiles[Unit::kTractor].T + profiles[Unit::kTrailer].T));
    }

    PerUnit<OverlapProfiles> profiles;
    Profiles confidence;
};

TEST(PaperStagesTest, TheLiteralStagesTwoAndThreeLeaveStageOneAsItIs) {
    const TwoViews views(0.5);
    for (const double beta : {0.1, 1.0, 100.0}) {
        const auto found =
            SolvePaperStages(views.profiles, views.confidence, Coupling::kLiteral, {.beta = beta});
        for (const Unit unit : kUnits) {
            const Profiles stage_1 = SmoothProfiles(views.profiles[unit].T, {});
            EXPECT_LT((found[unit].T_hat - stage_1).cwiseAbs().maxCoeff(), 1e-9) << beta;
        }
    }
}

TEST(PaperStagesTest, TheLiteralStagesRenderTheStitchingOffsetAlone) {
    const TwoViews views(0.5);
    const auto found = SolvePaperStages(views.profiles, views.confidence, Coupling::kLiteral, {});
    for (const Unit unit : kUnits) {
        const Profiles warp = found[unit].Warp(views.profiles[unit].T);
        EXPECT_LT((warp - views.profiles[unit].V).cwiseAbs().maxCoeff(), 1e-9);
    }
    EXPECT_LT(views.Misalignment(found), 1.5 * kMatchNoise_px) << "aligned";
    EXPECT_GT(views.ShownJitter(found), 0.9 * views.SeenJitter()) << "but not stabilised";
}

class KappaTest : public testing::TestWithParam<double> {};

TEST_P(KappaTest, TheCorrectedCouplingAlignsAndStabilises) {
    const TwoViews views(GetParam());
    const auto found = SolvePaperStages(views.profiles, views.confidence, Coupling::kCorrected,
                                        {.kappa = GetParam()});
    EXPECT_LT(views.Misalignment(found), 1.5 * kMatchNoise_px);
    EXPECT_LT(views.ShownJitter(found), 0.25 * views.SeenJitter());
}

TEST_P(KappaTest, TheStitchingThatIsLeftHoldsTheHitchAndNoShake) {
    const TwoViews views(GetParam());
    const auto found = SolvePaperStages(views.profiles, views.confidence, Coupling::kCorrected,
                                        {.kappa = GetParam()});
    const Profiles U = found[Unit::kTractor].V_hat - found[Unit::kTrailer].V_hat;
    const Profiles V = views.profiles[Unit::kTractor].V - views.profiles[Unit::kTrailer].V;
    EXPECT_GT(U.maxCoeff() - U.minCoeff(), 40) << "the swing";
    EXPECT_LT(Jitter(U.col(0)), 0.35 * Jitter(V.col(0)));
}

INSTANTIATE_TEST_SUITE_P(WhoMoves, KappaTest, testing::Values(0.0, 0.5, 1.0));

TEST(PaperStagesTest, AddingBothFieldsWithoutCouplingAlignsNothing) {
    const TwoViews views(0.5);
    PerUnit<OptimizedProfiles> sum;
    for (const Unit unit : kUnits) {
        sum[unit] = {SmoothProfiles(views.profiles[unit].T, {}), views.profiles[unit].V};
    }
    const auto found = SolvePaperStages(views.profiles, views.confidence, Coupling::kCorrected, {});
    EXPECT_GT(views.Misalignment(sum), 10 * views.Misalignment(found));
}

TEST(PaperStagesTest, StageThreeRegainsAlignmentThatSmoothingTheStitchingCost) {
    const TwoViews views(0.5);
    const auto solve = [&](double beta) {
        return SolvePaperStages(views.profiles, views.confidence, Coupling::kCorrected,
                                {.beta = beta, .mu = 1.2});
    };
    const double uncoupled = views.Misalignment(solve(0));
    double last = uncoupled;
    for (const double beta : {1.0, 10.0, 100.0}) {
        const double misaligned = views.Misalignment(solve(beta));
        EXPECT_LT(misaligned, last) << beta;
        last = misaligned;
    }
    EXPECT_LT(last, 0.5 * uncoupled);
}

TEST(PaperStagesTest, WithoutSmoothedStitchingStageThreeHasNothingToDo) {
    const TwoViews views(0.3);
    const auto found = SolvePaperStages(views.profiles, views.confidence, Coupling::kCorrected,
                                        {.beta = 50, .kappa = 0.3});
    for (const Unit unit : kUnits) {
        const Profiles stage_1 = SmoothProfiles(views.profiles[unit].T, {});
        EXPECT_LT((found[unit].T_hat - stage_1).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(SmoothByConfidenceTest, FramesWithoutMatchesAreBridged) {
    Profiles U = Profiles::Zero(40, 1);
    for (int t = 0; t < 40; ++t) U(t) = t;
    Profiles confidence = Profiles::Ones(40, 1);
    U.col(0).segment(15, 8).setConstant(1000);  // wrong, and known to be unknown
    confidence.col(0).segment(15, 8).setZero();
    const Profiles x = SmoothByConfidence(U, confidence, 0.05, 10);
    for (int t = 10; t < 30; ++t) EXPECT_NEAR(x(t), t, 1.0) << t;
}

TEST(SmoothByConfidenceTest, WhatWasNeverMatchedIsZero) {
    const Profiles U = Profiles::Constant(20, 2, 5);
    Profiles confidence = Profiles::Zero(20, 2);
    confidence(3, 1) = 1;
    const Profiles x = SmoothByConfidence(U, confidence, 0.1, 10);
    EXPECT_EQ(x.col(0).cwiseAbs().maxCoeff(), 0);
    EXPECT_LT((x.col(1).array() - 5).abs().maxCoeff(), 1e-6) << "held through the recording";
}

}  // namespace
}  // namespace hitchview::algo
