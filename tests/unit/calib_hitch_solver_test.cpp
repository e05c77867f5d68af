#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/hitch_solver.hpp"
#include "tests/support/unit_yard.hpp"

namespace hitchview::calib {
namespace {

using algo::Unit;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180;
/// The units' own frames in the frames with the origin in the hitch point.
const Vector3d kTractorOrigin_m(-0.3, 0.05, 0.1);
const Vector3d kTrailerOrigin_m(0.2, -0.04, 0.08);
constexpr double kTrailerYaw_rad = 2 * kDegree;

Isometry3d Placed(const Vector3d& at_m, double yaw_rad, double pitch_rad = 0) {
    Isometry3d T(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(pitch_rad, Vector3d::UnitY()));
    T.translation() = at_m;
    return T;
}

/// The simulated rig in a yard of ten boards, and where its units stand.
class HitchYard {
 public:
    explicit HitchYard(unsigned seed) : random_(seed) {
        for (const auto& camera : drivers::SimulatedRigGeometry(1280, 720)) {
            truth_.cameras[std::string(camera.name)] =
                CalibratedCamera::From(camera.unit, camera.geometry);
            algo::CameraGeometry own = camera.geometry;
            own.T_unit_camera = Own(camera.unit).inverse() * own.T_unit_camera;
            problem_.names.emplace_back(camera.name);
            problem_.cameras.push_back(CalibratedCamera::From(camera.unit, own));
            rig_.cameras[std::string(camera.name)] = problem_.cameras.back();
        }
        for (int i = 0; i < 10; ++i) {
            const double azimuth = 2 * std::numbers::pi * i / 10;
            const Vector3d at(6 * std::cos(azimuth), 5 * std::sin(azimuth), 0.6 + 0.3 * (i % 3));
            problem_.targets.push_back(
                {.name = std::string("t").append(std::to_string(i)), .board = tests::kYardBoard});
            T_world_target_.push_back(tests::UnitYard::Standing(at, {0, 0, 1}, 0.3));
        }
        problem_.height_m = -kTractorOrigin_m.z();
    }

    static Isometry3d Own(Unit unit) {
        return unit == Unit::kTractor ? Placed(kTractorOrigin_m, 0)
                                      : Placed(kTrailerOrigin_m, kTrailerYaw_rad);
    }

    void Shoot(const std::string& shot, double articulation_rad, double pitch_rad = 0) {
        const Isometry3d tractor = Placed({0.3 * shots_, 0.1 * shots_, 0}, 0.02 * shots_);
        const Isometry3d trailer = tractor * Placed(Vector3d::Zero(), articulation_rad, pitch_rad);
        ++shots_;
        for (std::size_t camera = 0; camera < problem_.cameras.size(); ++camera) {
            const CalibratedCamera& known = truth_.cameras.at(problem_.names[camera]);
            const Isometry3d T_world_camera =
                (known.unit == Unit::kTractor ? tractor : trailer) * known.Geometry().T_unit_camera;
            for (std::size_t target = 0; target < problem_.targets.size(); ++target)
                See(shot, camera, target, T_world_camera.inverse() * T_world_target_[target]);
        }
    }

    HitchProblem& problem() { return problem_; }
    std::vector<Isometry3d>& T_world_target() { return T_world_target_; }
    RigCalibration& rig() { return rig_; }
    RigCalibration& truth() { return truth_; }

 private:
    void See(const std::string& shot, std::size_t camera, std::size_t target,
             const Isometry3d& T_camera_target) {
        std::normal_distribution<double> noise(0, 0.3);
        Sighting sighting{camera, target, shot, {}};
        const algo::CameraModel& lens = problem_.cameras[camera].model;
        for (int i = 0; i < tests::kYardBoard.count(); i += 2) {
            const Vector3d p = T_camera_target * tests::kYardBoard.Corner(i);
            constexpr double kMostAslant = 0.25;
            if (p.normalized().dot(T_camera_target.linear().col(2)) < kMostAslant) return;
            const auto at = lens.Project(p);
            if (!at || at->x() < 0 || at->y() < 0 || at->x() > lens.width_px - 1 ||
                at->y() > lens.height_px - 1)
                continue;
            const double noise_y = noise(random_);
            const double noise_x = noise(random_);
            sighting.corners.push_back({i, *at + Eigen::Vector2d(noise_x, noise_y)});
        }
        if (sighting.corners.size() >= 6) problem_.sightings.push_back(std::move(sighting));
    }

    HitchProblem problem_;
    RigCalibration rig_;
    RigCalibration truth_;
    std::vector<Isometry3d> T_world_target_;
    std::mt19937 random_;
    int shots_ = 0;
};

void ShootTurns(HitchYard& yard, double most_rad) {
    yard.Shoot("1", 0);
    yard.Shoot("2", most_rad);
    yard.Shoot("3", -most_rad);
    yard.Shoot("4", most_rad / 2, 0.01);
    yard.Shoot("5", -most_rad / 2, -0.01);
    yard.problem().straight = {"1"};
}

TEST(HitchSolverTest, FindsThePointThatTheUnitsTurnAbout) {
    HitchYard yard(1);
    ShootTurns(yard, 35 * kDegree);
    const auto found = SolveHitch(yard.problem());
    ASSERT_TRUE(found);
    EXPECT_THAT(JudgeHitch(yard.problem(), *found), IsEmpty());

    const Vector3d in_tractor = HitchYard::Own(Unit::kTractor).inverse() * Vector3d::Zero();
    const Vector3d in_trailer = HitchYard::Own(Unit::kTrailer).inverse() * Vector3d::Zero();
    EXPECT_LT((found->hitch_tractor_m - in_tractor).head<2>().norm(), 0.005);
    EXPECT_LT((found->hitch_trailer_m - in_trailer).head<2>().norm(), 0.005);
    EXPECT_NEAR(found->straight_rad, kTrailerYaw_rad, 0.1 * kDegree);
    EXPECT_NEAR(found->sigma_px, 0.3, 0.02);
    const std::array expected{0.0, 35.0, -35.0, 17.5, -17.5};
    ASSERT_EQ(found->shots.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(found->shots[i].yaw_rad / kDegree, expected[i], 0.1);
}

TEST(HitchSolverTest, GivesTheCamerasPlacesAboutThatPoint) {
    HitchYard yard(2);
    ShootTurns(yard, 35 * kDegree);
    const auto found = SolveHitch(yard.problem());
    ASSERT_TRUE(found);
    for (const auto& [name, camera] : WithHitch(yard.rig(), *found).cameras) {
        const Isometry3d got = camera.Geometry().T_unit_camera;
        const Isometry3d truth = yard.truth().cameras.at(name).Geometry().T_unit_camera;
        EXPECT_LT(Eigen::AngleAxisd(got.linear().transpose() * truth.linear()).angle(),
                  0.1 * kDegree);
        EXPECT_LT((got.translation() - truth.translation()).head<2>().norm(), 0.007) << name;
    }
}

TEST(HitchSolverTest, TakesTheHeightThatWasGivenFromATrailerThatOnlyYaws) {
    HitchYard yard(3);
    yard.Shoot("1", 0);
    yard.Shoot("2", 0.5);
    yard.Shoot("3", -0.5);
    yard.problem().height_m = 0.4;
    const auto found = SolveHitch(yard.problem());
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->height_is_measured);
    EXPECT_NEAR(found->hitch_tractor_m.z(), 0.4, 0.03);
    // What the pictures do tell: how the frames' heights differ.
    EXPECT_NEAR(found->hitch_trailer_m.z() - found->hitch_tractor_m.z(),
                kTractorOrigin_m.z() - kTrailerOrigin_m.z(), 0.005);
}

TEST(HitchSolverTest, TheIntervalsHoldTheTruth) {
    constexpr int kRuns = 12;
    int held = 0;
    for (unsigned run = 0; run < kRuns; ++run) {
        HitchYard yard(10 + run);
        ShootTurns(yard, 35 * kDegree);
        const auto found = SolveHitch(yard.problem());
        ASSERT_TRUE(found);
        const Vector3d truth = HitchYard::Own(Unit::kTractor).inverse() * Vector3d::Zero();
        for (int axis = 0; axis < 2; ++axis) {
            if (std::abs(found->hitch_tractor_m[axis] - truth[axis]) <
                1.96 * found->sigma_tractor_m[axis])
                ++held;
        }
    }
    EXPECT_GE(held, 2 * kRuns - 4);
}

TEST(HitchSolverTest, AsksForATurnWhereThereIsNone) {
    HitchYard yard(4);
    ShootTurns(yard, 3 * kDegree);
    const auto found = SolveHitch(yard.problem());
    ASSERT_TRUE(found);
    EXPECT_THAT(JudgeHitch(yard.problem(), *found),
                Contains(HasSubstr("turn by at least 20 degrees")));
}

TEST(HitchSolverTest, AsksForAStraightShot) {
    HitchYard yard(5);
    ShootTurns(yard, 35 * kDegree);
    yard.problem().straight = {"none"};
    const auto found = SolveHitch(yard.problem());
    ASSERT_TRUE(found);
    EXPECT_THAT(JudgeHitch(yard.problem(), *found),
                Contains(HasSubstr("no shot is said to be straight")));
    yard.problem().straight = {"1", "4"};
    EXPECT_THAT(JudgeHitch(yard.problem(), *SolveHitch(yard.problem())),
                Contains(HasSubstr("straight shot 4 is ")));
}

TEST(HitchSolverTest, NamesATargetThatMovedBetweenTheShots) {
    HitchYard yard(7);
    yard.Shoot("1", 0);
    yard.Shoot("2", 0.5);
    yard.Shoot("3", -0.5);
    yard.T_world_target()[0].translation().x() += 0.1;
    yard.Shoot("4", 0.3);
    yard.problem().straight = {"1"};
    const auto found = SolveHitch(yard.problem());
    ASSERT_TRUE(found);
    EXPECT_THAT(JudgeHitch(yard.problem(), *found), Contains(HasSubstr("t0 in shot 4 of ")));
}

TEST(HitchSolverTest, NamesAShotThatNothingLinksToTheOthers) {
    HitchYard yard(8);
    ShootTurns(yard, 35 * kDegree);
    HitchProblem& problem = yard.problem();
    std::erase_if(problem.sightings, [&](const Sighting& sighting) {
        return sighting.shot == "4" && problem.cameras[sighting.camera].unit == Unit::kTractor;
    });
    const auto found = SolveHitch(problem);
    ASSERT_TRUE(found);
    EXPECT_THAT(found->loose_shots, testing::ElementsAre("4"));
    EXPECT_EQ(found->shots.size(), 4U);
}

TEST(HitchSolverTest, HasNoAnswerWhereOnlyOneUnitIsSeen) {
    HitchYard yard(6);
    ShootTurns(yard, 35 * kDegree);
    HitchProblem& problem = yard.problem();
    std::erase_if(problem.sightings, [&](const Sighting& sighting) {
        return problem.cameras[sighting.camera].unit == Unit::kTrailer;
    });
    EXPECT_FALSE(SolveHitch(problem));
}

}  // namespace
}  // namespace hitchview::calib
