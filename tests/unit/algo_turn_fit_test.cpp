#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "algo/turn_fit.hpp"

namespace hitchview::algo {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPxPerRad = 326;

/// A unit with a camera ahead and one on each side, among scene points.
class TurnFitTest : public testing::Test {
 protected:
    /// Scene points 5 to `farthest_m` away all round, or on the left alone, as two frames show
    /// them. `noise_px`: of each direction.
    std::vector<SightMotion> Sights(int count, bool left_alone, double farthest_m,
                                    double noise_px) {
        std::vector<SightMotion> sights;
        for (int i = 0; i < count; ++i) {
            const double azimuth =
                left_alone ? random_.uniform(0.6, 2.0) : random_.uniform(-2., 2.);
            const double distance_m = 1 / random_.uniform(1 / farthest_m, 1.0 / 5);
            const Vector3d origin_m{azimuth > -0.5 && azimuth < 0.5 ? 4.0 : 0.9,
                                    azimuth > 0 ? 1.2 : -1.2, 1};
            const Vector3d direction{std::cos(azimuth), std::sin(azimuth),
                                     random_.uniform(-0.15, 0.3)};
            const Vector3d point_m = origin_m + distance_m * direction;
            sights.push_back({Noisy(point_m - origin_m, noise_px),
                              Noisy(R_ * point_m + t_m_ - origin_m, noise_px), origin_m});
        }
        return sights;
    }

    Vector3d Noisy(const Vector3d& direction, double noise_px) {
        const double noise = noise_px / kPxPerRad;
        const Vector3d error{random_.gaussian(noise), random_.gaussian(noise),
                             random_.gaussian(noise)};
        return (direction.normalized() + error).normalized();
    }

    static double Between_px(const Matrix3d& a, const Matrix3d& b) {
        return kPxPerRad * AngleAxisd(Matrix3d(a * b.transpose())).angle();
    }

    cv::RNG random_{5};
    Matrix3d R_ = (AngleAxisd(0.015, Vector3d::UnitZ()) * AngleAxisd(-0.01, Vector3d::UnitY()) *
                   AngleAxisd(0.006, Vector3d::UnitX()))
                      .toRotationMatrix();
    Vector3d t_m_{-0.27, 0.02, -0.01};
    TurnFit fit_{TurnFitOptions{.px_per_rad = kPxPerRad}};
};

TEST_F(TurnFitTest, NearThingsOnBothSidesDoNotHideTheTurn) {
    const auto turn = fit_.Fit(Sights(200, false, 100, 0.2), R_);
    ASSERT_TRUE(turn.has_value());
    EXPECT_LT(Between_px(turn->R_late_early, R_), 0.25);
    EXPECT_GT(turn->inliers, 160);
}

/// As at night, when the left side is lit: its parallax is no turn to the left.
TEST_F(TurnFitTest, OneSideFullOfNearThingsDoesNotOutvoteAFewAhead) {
    std::vector<SightMotion> sights = Sights(200, true, 15, 0.2);
    for (const SightMotion& sight : Sights(100, false, 1000, 0.2)) sights.push_back(sight);
    const Matrix3d R_wrong = AngleAxisd(0.02, Vector3d::UnitZ()) * R_;
    const auto turn = fit_.Fit(sights, R_wrong);
    ASSERT_TRUE(turn.has_value());
    EXPECT_LT(Between_px(turn->R_late_early, R_), 1.5);
}

TEST_F(TurnFitTest, AUnitThatTurnsOnTheSpotNeedsNoTravel) {
    t_m_.setZero();
    const auto turn = fit_.Fit(Sights(200, false, 100, 0.2), R_);
    ASSERT_TRUE(turn.has_value());
    EXPECT_LT(Between_px(turn->R_late_early, R_), 0.7);
}

TEST_F(TurnFitTest, ThingsThatMoveThemselvesAreNoTurn) {
    std::vector<SightMotion> sights = Sights(200, false, 100, 0.2);
    for (std::size_t i = 0; i < 60; ++i)
        sights[i].late = (sights[i].late + Vector3d{0, 0.01, 0.05}).normalized();
    const auto turn = fit_.Fit(sights, R_);
    ASSERT_TRUE(turn.has_value());
    EXPECT_LT(Between_px(turn->R_late_early, R_), 0.4);
    EXPECT_LT(turn->inliers, 160);
}

TEST_F(TurnFitTest, TooFewSightsDetermineNothing) {
    EXPECT_FALSE(fit_.Fit({}, R_).has_value());
    EXPECT_FALSE(fit_.Fit(Sights(2, true, 100, 0), R_).has_value());
}

TEST_F(TurnFitTest, TheSameSightsAfterAResetGiveTheSameTurn) {
    const std::vector<SightMotion> sights = Sights(100, false, 50, 0.3);
    const auto first = fit_.Fit(sights, R_);
    fit_.Fit(Sights(100, true, 20, 0.3), R_);
    fit_.Reset();
    const auto again = fit_.Fit(sights, R_);
    ASSERT_TRUE(first && again);
    EXPECT_EQ(first->R_late_early, again->R_late_early);
}

}  // namespace
}  // namespace hitchview::algo
