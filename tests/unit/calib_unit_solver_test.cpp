#include <gtest/gtest.h>

#include <array>

#include "calib/unit_solver.hpp"
#include "tests/support/unit_yard.hpp"

namespace hitchview::calib {
namespace {

using algo::Unit;
using tests::UnitYard;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSurvey_m = 0.002;

using Six = Eigen::Matrix<double, 6, 1>;

/// Roll, pitch, yaw, position of what was found, less the truth.
Six Errors(const PlacedCamera& found, const Eigen::Isometry3d& truth) {
    Six errors;
    errors << found.rpy_rad - RpyOf(truth), found.T_unit_camera.translation() - truth.translation();
    for (int i = 0; i < 3; ++i) errors[i] = std::remainder(errors[i], 2 * std::numbers::pi);
    return errors;
}

Six Sigmas(const PlacedCamera& found) {
    Six sigmas;
    sigmas << found.rpy_sigma_rad, found.position_sigma_m;
    return sigmas;
}

class UnitSolverTest : public testing::TestWithParam<Unit> {};

INSTANTIATE_TEST_SUITE_P(Units, UnitSolverTest, testing::Values(Unit::kTractor, Unit::kTrailer),
                         [](const auto& unit) { return std::string(ToString(unit.param)); });

void ExpectTruth(UnitYard& yard, const std::optional<UnitSolution>& found) {
    ASSERT_TRUE(found);
    for (std::size_t i = 0; i < found->cameras.size(); ++i) {
        const Six errors = Errors(found->cameras[i], yard.T_unit_camera()[i]);
        const std::string& name = yard.problem().cameras[i].name;
        EXPECT_LT(errors.head<3>().cwiseAbs().maxCoeff(), 0.05 * kDegree) << name;
        EXPECT_LT(errors.tail<3>().norm(), 0.005) << name;
        EXPECT_LT(found->cameras[i].rpy_sigma_rad.maxCoeff(), 0.05 * kDegree) << name;
    }
    EXPECT_NEAR(found->sigma_px, 0.3, 0.03);
}

void OnlyOwnTargets(UnitProblem& problem) {
    std::erase_if(problem.sightings, [](const Sighting& s) {
        return s.target / tests::kBoardsBeforeEach != s.camera;
    });
}

TEST_P(UnitSolverTest, SurveyedTargetsOfItsOwnGiveEachCamerasPlace) {
    UnitYard yard(GetParam(), 3);
    tests::SurveyBoardsBeforeEach(yard, kSurvey_m);
    yard.Shoot("1");
    OnlyOwnTargets(yard.problem());
    const CameraGraph graph = BuildCameraGraph(yard.problem());
    ASSERT_TRUE(graph.missing.empty()) << graph.missing.front();
    ExpectTruth(yard, SolveUnit(yard.problem(), graph));
}

TEST_P(UnitSolverTest, TargetsThatNeighboursShareLeadFromOneSurveyedPlaceToEachCamera) {
    UnitYard yard(GetParam(), 4);
    tests::SurveyBoardsBeforeEach(yard, kSurvey_m);
    yard.Shoot("1");
    // Surveyed boards before one camera only: the first of three, the third of five.
    const std::size_t surveyed = GetParam() == Unit::kTractor ? 0 : 2;
    std::erase_if(yard.problem().sightings, [&](const Sighting& s) {
        return s.camera != surveyed || s.target / tests::kBoardsBeforeEach != surveyed;
    });
    tests::CarryBoardPastNeighbours(yard, 12);
    std::erase_if(yard.problem().sightings, [&](const Sighting& s) {
        return s.shot != "1" && s.target + 1 != yard.problem().targets.size();
    });
    const CameraGraph graph = BuildCameraGraph(yard.problem());
    ASSERT_TRUE(graph.missing.empty()) << graph.missing.front();
    ExpectTruth(yard, SolveUnit(yard.problem(), graph));
}

TEST(UnitIntervalTest, HoldTheTruthAsOftenAsTheySay) {
    constexpr int kRuns = 100;
    constexpr double kNinetyFivePercent = 1.96;
    std::array<std::array<int, 6>, 3> held{};
    for (unsigned run = 0; run < kRuns; ++run) {
        UnitYard yard(Unit::kTractor, 100 + run);
        tests::SurveyBoardsBeforeEach(yard, kSurvey_m);
        yard.Shoot("1");
        const CameraGraph graph = BuildCameraGraph(yard.problem());
        UnitPlaces start{yard.T_unit_camera(), {}, std::vector(yard.T_unit_target().size(), 1.0)};
        for (const TargetNode& node : graph.nodes)
            start.T_unit_target.push_back(yard.T_unit_target()[node.target]);
        const auto found = SolveUnitFrom(start, yard.problem(), graph);
        ASSERT_TRUE(found);
        for (std::size_t camera = 0; camera < 3; ++camera) {
            const Six errors = Errors(found->cameras[camera], yard.T_unit_camera()[camera]);
            const Six sigmas = Sigmas(found->cameras[camera]);
            for (int i = 0; i < 6; ++i) {
                if (std::abs(errors[i]) <= kNinetyFivePercent * sigmas[i])
                    ++held[camera][static_cast<std::size_t>(i)];
            }
        }
    }
    for (std::size_t camera = 0; camera < 3; ++camera) {
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_GE(held[camera][i], 90) << camera << " parameter " << i;
            EXPECT_LE(held[camera][i], 99) << camera << " parameter " << i;
        }
    }
}

}  // namespace
}  // namespace hitchview::calib
