#include <gtest/gtest.h>

#include <cmath>

#include "drivers/simulated_motion.hpp"

namespace hitchview::drivers {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using std::chrono::milliseconds;

double Yaw(const Isometry3d& T_world_unit) {
    const Vector3d forward = T_world_unit.linear().col(0);
    return std::atan2(forward.y(), forward.x());
}

TEST(SimulatedMotionTest, AConstantTurnLeadsToTheSteadyHitchAngle) {
    for (const double curvature : {0.02, 0.1, 0.45}) {
        SimulationOptions options;
        options.profile = DriveProfile::kTurnLeft;
        options.curvature_per_m = curvature;
        const Motion motion(options);
        const double angle = motion.HitchAngleAt(std::chrono::seconds(8));
        EXPECT_NEAR(angle, SteadyHitchAngle(curvature), 1e-6);
        // Both axles and the hitch turn about one centre: the oracle is plain geometry.
        const double radius = 1 / curvature;
        const double hitch_radius = std::hypot(radius, VehicleDimensions::kTractorAxle);
        const double trailer = std::asin(VehicleDimensions::kTrailerAxle / hitch_radius);
        EXPECT_NEAR(angle, -(std::atan(VehicleDimensions::kTractorAxle / radius) + trailer), 1e-6);
    }
}

TEST(SimulatedMotionTest, ATurnToTheRightMirrorsATurnToTheLeft) {
    SimulationOptions options;
    options.profile = DriveProfile::kTurnLeft;
    const Motion left(options);
    options.profile = DriveProfile::kTurnRight;
    const Motion right(options);
    EXPECT_LT(left.HitchAngleAt(milliseconds(2345)), 0);
    EXPECT_NEAR(left.HitchAngleAt(milliseconds(2345)), -right.HitchAngleAt(milliseconds(2345)),
                1e-12);
}

TEST(SimulatedMotionTest, TheHitchAngleIsTheYawBetweenTheUnits) {
    const Motion motion(SimulationOptions{});
    for (const milliseconds t : {milliseconds(0), milliseconds(1234), milliseconds(4321)}) {
        const Isometry3d tractor = motion.PoseAt(t, algo::Unit::kTractor, Shaking::kWithout);
        const Isometry3d trailer = motion.PoseAt(t, algo::Unit::kTrailer, Shaking::kWithout);
        EXPECT_NEAR(Yaw(tractor.inverse() * trailer), motion.HitchAngleAt(t), 1e-12);
        EXPECT_LT((tractor.translation() - trailer.translation()).norm(), 1e-12);
    }
}

TEST(SimulatedMotionTest, TheTrailerAxleDoesNotSlipSideways) {
    const Motion motion(SimulationOptions{});
    const Vector3d axle{-VehicleDimensions::kTrailerAxle, 0, 0};
    for (int t = 500; t < 9000; t += 700) {
        const auto pose = [&](int ms) {
            return motion.PoseAt(milliseconds(ms), algo::Unit::kTrailer, Shaking::kWithout);
        };
        const Vector3d moved = pose(t + 1) * axle - pose(t - 1) * axle;
        EXPECT_NEAR((pose(t).linear().transpose() * moved).y(), 0, 1e-5) << t;
        EXPECT_NEAR(moved.norm(), 0.016, 2e-3) << t;
    }
}

TEST(SimulatedMotionTest, ShakingHasTheAmplitudeAskedFor) {
    const ShakeOptions options{.roll_pitch_rad = 0.01, .yaw_rad = 0.005, .translation_m = 0.02};
    const Shake shake(options, 7);
    constexpr int kSamples = 60000;
    Vector3d translation = Vector3d::Zero();
    Vector3d angles = Vector3d::Zero();
    for (int i = 0; i < kSamples; ++i) {
        const Isometry3d T = shake.At(i * 0.00731);
        const Eigen::Matrix3d R = T.linear();
        translation += T.translation().cwiseAbs2();
        angles += Vector3d{R(2, 1), R(0, 2), R(1, 0)}.cwiseAbs2();  // small angles
    }
    const Vector3d translation_rms = (translation / kSamples).cwiseSqrt();
    const Vector3d angle_rms = (angles / kSamples).cwiseSqrt();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(translation_rms[i], 0.02, 0.002);
    EXPECT_NEAR(angle_rms[0], 0.01, 0.001);
    EXPECT_NEAR(angle_rms[1], 0.01, 0.001);
    EXPECT_NEAR(angle_rms[2], 0.005, 0.0005);
}

TEST(SimulatedMotionTest, TheUnitsShakeIndependently) {
    SimulationOptions options;
    const Motion both(options);
    options.shake[algo::Unit::kTractor].scale = 0;
    const Motion trailer_only(options);
    double correlation = 0;
    double tractor_power = 0;
    double trailer_power = 0;
    for (int t = 0; t < 10000; t += 7) {
        const auto pitch = [&](algo::Unit unit) {
            return both.PoseAt(milliseconds(t), unit, Shaking::kWith).linear()(2, 0);
        };
        const double tractor = pitch(algo::Unit::kTractor);
        const double trailer = pitch(algo::Unit::kTrailer);
        correlation += tractor * trailer;
        tractor_power += tractor * tractor;
        trailer_power += trailer * trailer;
        const auto still =
            trailer_only.PoseAt(milliseconds(t), algo::Unit::kTractor, Shaking::kWith);
        EXPECT_TRUE(still.isApprox(
            both.PoseAt(milliseconds(t), algo::Unit::kTractor, Shaking::kWithout), 1e-12));
        EXPECT_EQ(
            trailer_only.PoseAt(milliseconds(t), algo::Unit::kTrailer, Shaking::kWith).matrix(),
            both.PoseAt(milliseconds(t), algo::Unit::kTrailer, Shaking::kWith).matrix());
    }
    EXPECT_LT(std::abs(correlation) / std::sqrt(tractor_power * trailer_power), 0.15);
}

TEST(SimulationOptionsTest, DefaultsAreAllowed) {
    EXPECT_TRUE(CheckOptions({}).ok());
}

TEST(SimulationOptionsTest, AnOptionOutOfRangeIsNamed) {
    const auto error = [](auto change) {
        SimulationOptions options;
        change(options);
        const auto checked = CheckOptions(options);
        return checked.ok() ? std::string("ok") : checked.error();
    };
    EXPECT_EQ(error([](auto& o) { o.frames = 0; }),
              "simulation: frames is 0, allowed is 1 to 36000");
    EXPECT_NE(error([](auto& o) { o.width_px = 1281; }).find("width_px modulo 2"),
              std::string::npos);
    EXPECT_NE(error([](auto& o) { o.height_px = 2000; }).find("1280"), std::string::npos);
    EXPECT_NE(error([](auto& o) { o.noise_sigma = NAN; }).find("noise_sigma"), std::string::npos);
    EXPECT_NE(error([](auto& o) { o.shake[algo::Unit::kTrailer].scale = -1; }).find("shake.scale"),
              std::string::npos);
    EXPECT_NE(error([](auto& o) { o.curvature_per_m = 0.4; }).find("slalom heading"),
              std::string::npos);
}

}  // namespace
}  // namespace hitchview::drivers
