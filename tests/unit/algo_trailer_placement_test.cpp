#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core.hpp>

#include "algo/trailer_placement.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr double kGain = 0.3;
const Projection kPlane = Projection::Plane(800, 400);
const Projection kRing = Projection::Cylinder(1600, 320, 0.5);

class TrailerPlacementTest : public testing::TestWithParam<Projection> {
 protected:
    /// What both units see under `pose`, in two parts of the tractor's view.
    PerOverlap<InterFeatures> Pairs(const Matrix3d& pose, double outliers = 0,
                                    double noise_px = 0) {
        PerOverlap<InterFeatures> pairs;
        for (const Overlap overlap : kOverlaps) {
            const double x0 = overlap == Overlap::kLeft ? 40 : 500;
            for (int i = 0; i < 60; ++i) {
                Vector2d tractor{x0 + random_.uniform(0.0, 250.0), random_.uniform(20.0, 300.0)};
                const Vector2d trailer = view_.Pixel(pose.inverse() * view_.Ray(tractor));
                tractor += Vector2d{random_.gaussian(noise_px), random_.gaussian(noise_px)};
                if (random_.uniform(0.0, 1.0) < outliers) {
                    tractor = {random_.uniform(0.0, 799.0), random_.uniform(0.0, 319.0)};
                }
                pairs[overlap].push_back({tractor, trailer});
            }
        }
        return pairs;
    }

    /// How far the pose moves a pixel of the trailer's view from where `truth` puts it.
    double Error(const Matrix3d& truth) const {
        double worst = 0;
        for (double x = 30; x < 400; x += 60) {
            const auto ray = view_.Ray({x, 150});
            worst =
                std::max(worst, view_
                                    .Difference(view_.Pixel(placement_->M_tractor_trailer() * ray),
                                                view_.Pixel(truth * ray))
                                    .norm());
        }
        return worst;
    }

    Matrix3d Pose(double heading_px, double second, double third) const {
        return ToPose(view_, {{heading_px, view_.IsRing() ? second / 500 : second, third}});
    }

    Projection view_ = GetParam();
    cv::RNG random_{17};
    Matrix3d truth_ = Pose(220, 8, 0.02);
    std::unique_ptr<TrailerPlacement> placement_ =
        std::make_unique<TrailerPlacement>(view_, view_, TrailerPlacementOptions{.gain = kGain});
};

TEST_P(TrailerPlacementTest, IsAcquiredFromPairsOfWhichHalfAreWrong) {
    placement_->Start(Matrix3d::Identity());
    EXPECT_FALSE(placement_->acquired());
    ASSERT_TRUE(placement_->Acquire(Pairs(truth_, 0.5, 0.5)));
    EXPECT_TRUE(placement_->acquired());
    EXPECT_LT(Error(truth_), 1.0);
    for (const Overlap overlap : kOverlaps) {
        EXPECT_NEAR(placement_->inliers()[overlap], 30, 12) << ToString(overlap);
    }
}

TEST_P(TrailerPlacementTest, ManyPairsOfWhichFewAgreeAcquireNothing) {
    placement_->Start(Matrix3d::Identity());
    EXPECT_FALSE(placement_->Acquire(Pairs(truth_, 0.85, 0.5)));
    EXPECT_FALSE(placement_->acquired());
}

TEST_P(TrailerPlacementTest, TooFewPairsAcquireNothingAndChangeNothing) {
    placement_->Start(truth_);
    PerOverlap<InterFeatures> few = Pairs(Pose(-50, 0, 0));
    few[Overlap::kLeft].truncate(8);
    few[Overlap::kRight].clear();
    EXPECT_FALSE(placement_->Acquire(few));
    EXPECT_FALSE(placement_->Correct(few));
    EXPECT_EQ(placement_->M_tractor_trailer(), truth_);
    EXPECT_FALSE(placement_->acquired());
}

TEST_P(TrailerPlacementTest, TheIntraMotionsOfBothUnitsCarryThePoseOnExactly) {
    placement_->Start(truth_);
    Matrix3d truth = truth_;
    for (int i = 0; i < 30; ++i) {
        // A point seen at p in the early trailer view is seen at B p in the late one, and likewise
        // A.
        const auto any = [&] {
            return Pose(random_.gaussian(6), random_.gaussian(3), random_.gaussian(0.01));
        };
        PerUnit<IntraMotion> intra;
        intra[Unit::kTractor].M_late_early = any();
        intra[Unit::kTrailer].M_late_early = any();
        const Matrix3d& a = intra[Unit::kTractor].M_late_early;
        const Matrix3d& b = intra[Unit::kTrailer].M_late_early;
        truth = a * truth * b.inverse();
        const auto scene_in_trailer = view_.Ray({300, 150});
        const Vector2d early_tractor =
            view_.Pixel(placement_->M_tractor_trailer() * scene_in_trailer);
        placement_->Predict(intra);
        const Vector2d late_tractor =
            view_.Pixel(placement_->M_tractor_trailer() * (b * scene_in_trailer));
        EXPECT_LT(view_.Difference(view_.Pixel(a * view_.Ray(early_tractor)), late_tractor).norm(),
                  1e-8);
    }
    EXPECT_LT(Error(truth), 1e-6);
}

TEST_P(TrailerPlacementTest, CorrectionsLeadAWrongPoseToTheTruth) {
    ASSERT_TRUE(placement_->Acquire(Pairs(truth_)));
    const Matrix3d moved = Pose(226, 5, 0.015);
    double last = 1e9;
    for (int i = 0; i < 25; ++i) {
        ASSERT_TRUE(placement_->Correct(Pairs(moved, 0.3, 0)));
        EXPECT_LE(Error(moved), last + 0.02) << i;
        last = Error(moved);
    }
    EXPECT_LT(last, 0.05);
}

TEST_P(TrailerPlacementTest, OnceSettledTheNoiseOfOneFrameCountsByTheGainOnly) {
    ASSERT_TRUE(placement_->Acquire(Pairs(truth_)));
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(placement_->Correct(Pairs(truth_)));
    const Matrix3d jump = Pose(230, 8, 0.02);
    ASSERT_TRUE(placement_->Correct(Pairs(jump)));
    EXPECT_NEAR(Error(truth_), kGain * 10, 0.3);
}

TEST_P(TrailerPlacementTest, APairAgreesIfThePosePutsItWithinTheLimit) {
    placement_->Start(truth_);
    const Vector2d trailer{200, 150};
    const Vector2d there = view_.Pixel(truth_ * view_.Ray(trailer));
    EXPECT_TRUE(placement_->Agrees({there + Vector2d{1.9, 0}, trailer}, 2));
    EXPECT_FALSE(placement_->Agrees({there + Vector2d{0, 2.1}, trailer}, 2));
    const Vector2d a_turn_away{there.x() + view_.width_px, there.y()};
    EXPECT_EQ(placement_->Agrees({a_turn_away, trailer}, 2), view_.IsRing());
}

INSTANTIATE_TEST_SUITE_P(Views, TrailerPlacementTest, testing::Values(kPlane, kRing),
                         [](const auto& test) { return test.param.IsRing() ? "Ring" : "Plane"; });

TEST(TrailerPlacementRingTest, NeitherPredictionNorFitLeavesTheWall) {
    const Eigen::Vector3d wall(300, 0.1, 0.1);
    const auto placement =
        std::make_unique<TrailerPlacement>(kRing, kRing, TrailerPlacementOptions{.wall = wall});
    const auto pose = [](double heading_px, double roll_rad) {
        return ToPose(kRing, {{heading_px, roll_rad, 0}});
    };
    const auto pairs = [](const Matrix3d& truth) {
        PerOverlap<InterFeatures> seen;
        for (int i = 0; i < 50; ++i) {
            const Vector2d trailer{100 + 12.0 * i, 40 + 37.0 * (i % 7)};
            seen[Overlap::kLeft].push_back({kRing.Pixel(truth * kRing.Ray(trailer)), trailer});
        }
        return seen;
    };
    const auto heading_px = [&] {
        return ToOffset(kRing, placement->M_tractor_trailer()).value.x();
    };
    EXPECT_FALSE(placement->Acquire(pairs(pose(320, 0))));
    EXPECT_FALSE(placement->Acquire(pairs(pose(200, 0.12))));
    ASSERT_TRUE(placement->Acquire(pairs(pose(290, 0))));
    EXPECT_NEAR(heading_px(), 290, 0.1);

    PerUnit<IntraMotion> turning;
    turning[Unit::kTractor].M_late_early = pose(7, 0);
    for (int i = 0; i < 100; ++i) {
        placement->Predict(turning);
        EXPECT_LE(heading_px(), 300 + 1e-6) << i;
    }
    EXPECT_NEAR(heading_px(), 300, 1e-6);
    turning[Unit::kTractor].M_late_early = pose(-7, 0);
    placement->Predict(turning);
    EXPECT_NEAR(heading_px(), 293, 1e-6) << "what was beyond is forgotten";
}

TEST(TrailerPlacementPlaneTest, ATrailerViewOfAnotherScaleIsAcquired) {
    const auto placement =
        std::make_unique<TrailerPlacement>(kPlane, kPlane, TrailerPlacementOptions{});
    Matrix3d truth;
    truth << 1.08, -0.04, 300, 0.04, 1.08, -20, 0, 0, 1;
    PerOverlap<InterFeatures> pairs;
    for (int i = 0; i < 50; ++i) {
        const Vector2d trailer{7.0 * i, 37.0 * (i % 11)};
        pairs[Overlap::kRight].push_back({(truth * trailer.homogeneous()).hnormalized(), trailer});
    }
    ASSERT_TRUE(placement->Acquire(pairs));
    EXPECT_LT((placement->M_tractor_trailer() - truth).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_EQ(placement->inliers()[Overlap::kRight], 50);
    EXPECT_EQ(placement->inliers()[Overlap::kLeft], 0);
}

}  // namespace
}  // namespace hitchview::algo
