#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>

#include "algo/stabilization_motion_field.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

const Projection kPlane = Projection::Plane(640, 360);
const Projection kRing = Projection::Cylinder(1024, 200, 0.5);

FeatureMotions Motions(const Projection& view, const Matrix3d& pose, double outliers,
                       double noise_px) {
    cv::RNG random(12);
    FeatureMotions motions;
    for (int i = 0; i < 250; ++i) {
        const Vector2d early{random.uniform(0.0, view.width_px - 1.0),
                             random.uniform(0.0, view.height_px - 1.0)};
        Vector2d late = view.Pixel(pose * view.Ray(early));
        late += Vector2d{random.gaussian(noise_px), random.gaussian(noise_px)};
        if (random.uniform(0.0, 1.0) < outliers) {
            late = early + Vector2d{random.gaussian(25), random.gaussian(25)};
        }
        motions.push_back({early, late});
    }
    return motions;
}

class EveryViewTest : public testing::TestWithParam<Projection> {
 protected:
    void Estimate(const FeatureMotions& motions) { estimator_->Estimate(motions, {}, motion_); }
    double ErrorAt(const Matrix3d& truth, const Vector2d& at) const {
        const Vector3d ray = view_.Ray(at);
        return view_.Difference(view_.Pixel(motion_.M_late_early * ray), view_.Pixel(truth * ray))
            .norm();
    }

    Projection view_ = GetParam();
    Matrix3d truth_ = ToPose(view_, {{7, view_.IsRing() ? 0.01 : -4, 0.015}});
    std::unique_ptr<StabilizationMotionField> estimator_ =
        std::make_unique<StabilizationMotionField>(view_, StabilizationMotionFieldOptions{});
    IntraMotion motion_;
};

TEST_P(EveryViewTest, TheGlobalMotionIsFoundAndLeavesNoResidual) {
    Estimate(Motions(view_, truth_, 0, 0));
    ASSERT_TRUE(motion_.known);
    EXPECT_EQ(motion_.inliers, 250);
    EXPECT_LT(ErrorAt(truth_, {30, 40}), 1e-6);
    EXPECT_LT(motion_.residual.cwiseAbs().maxCoeff(), 1e-5F);
}

TEST_P(EveryViewTest, OutliersAndNoiseHardlyChangeTheGlobalMotion) {
    Estimate(Motions(view_, truth_, 0.4, 0.3));
    ASSERT_TRUE(motion_.known);
    for (double x = 0; x < view_.width_px; x += 50) EXPECT_LT(ErrorAt(truth_, {x, 100}), 0.25) << x;
    EXPECT_LT(motion_.residual.cwiseAbs().maxCoeff(), 0.6F);
}

TEST_P(EveryViewTest, TooFewFeaturesMeanNoMotion) {
    FeatureMotions few = Motions(view_, truth_, 0, 0);
    few.truncate(9);
    motion_.residual.setConstant(5);
    Estimate(few);
    EXPECT_FALSE(motion_.known);
    EXPECT_EQ(motion_.M_late_early, Matrix3d::Identity());
    EXPECT_EQ(motion_.residual, VertexField::Zero());
    Estimate({});
    EXPECT_FALSE(motion_.known);
    EXPECT_EQ(motion_.inliers, 0);
}

TEST_P(EveryViewTest, WhatOneRegionMovesByItselfIsItsResidual) {
    const Vector2d middle{view_.width_px / 2.0, view_.height_px / 2.0};
    FeatureMotions motions = Motions(view_, Matrix3d::Identity(), 0, 0);
    for (FeatureMotion& motion : motions) {
        const Vector2d from_middle = (motion.early_px - middle).cwiseAbs();
        if (from_middle.maxCoeff() < 75) motion.late_px.x() += 1.5;
    }
    Estimate(motions);
    ASSERT_TRUE(motion_.known);
    const Mesh mesh(view_);
    EXPECT_GT(Sample(mesh, motion_.residual, middle).x(), 0.7);
    EXPECT_LT(std::abs(Sample(mesh, motion_.residual, {20, middle.y()}).x()), 0.5);
}

INSTANTIATE_TEST_SUITE_P(Views, EveryViewTest, testing::Values(kPlane, kRing),
                         [](const auto& test) { return test.param.IsRing() ? "Ring" : "Plane"; });

}  // namespace
}  // namespace hitchview::algo
