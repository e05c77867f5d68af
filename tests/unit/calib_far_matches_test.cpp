#include <gtest/gtest.h>

#include <algorithm>

#include "calib/far_matches.hpp"
#include "calib/unit_solver.hpp"
#include "tests/support/simulated_pictures.hpp"
#include "tests/support/unit_yard.hpp"

namespace hitchview::calib {
namespace {

using algo::Unit;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using tests::UnitYard;

constexpr double kPanorama_px = 4096;

/// Pictures of a unit's cameras while the rig drives down its road.
std::vector<cv::Mat> Pictures(Unit unit) {
    const auto rig = tests::Rig({.frames = 40, .profile = drivers::DriveProfile::kStraight});
    std::vector<cv::Mat> pictures;
    for (int camera = 0; camera < drivers::SimulatedRig::kCameras; ++camera) {
        if (rig->camera(camera).unit != unit) continue;
        auto nv12 = tests::Rendered(*rig, camera, 30);
        pictures.push_back(cv::Mat(720, 1280, CV_8U, nv12.data()).clone());
    }
    return pictures;
}

/// Between neighbours, in directions that both see: how far apart they put what is infinitely far
/// away, in pixels of the panorama.
std::vector<double> MisalignmentAtInfinity(const UnitProblem& problem,
                                           const std::vector<Isometry3d>& truth,
                                           const std::vector<Isometry3d>& found) {
    std::vector<double> pixels;
    const auto sees = [&](std::size_t camera, const Vector3d& direction) {
        const algo::CameraModel& lens = problem.cameras[camera].model;
        const auto at = lens.Project(truth[camera].linear().transpose() * direction);
        return at && at->x() >= 0 && at->y() >= 0 && at->x() < lens.width_px &&
               at->y() < lens.height_px;
    };
    for (std::size_t a = 0; a < truth.size(); ++a) {
        for (std::size_t b = a + 1; b < truth.size(); ++b) {
            for (double azimuth = -3.1; azimuth < 3.1; azimuth += 0.02) {
                for (double up = -0.5; up < 0.5; up += 0.02) {
                    const Vector3d ray =
                        Vector3d(std::cos(azimuth), std::sin(azimuth), up).normalized();
                    if (!sees(a, ray) || !sees(b, ray)) continue;
                    const Vector3d by_a = found[a].linear() * truth[a].linear().transpose() * ray;
                    const Vector3d by_b = found[b].linear() * truth[b].linear().transpose() * ray;
                    pixels.push_back((by_a - by_b).norm() * kPanorama_px / (2 * std::numbers::pi));
                }
            }
        }
    }
    return pixels;
}

double Median(std::vector<double> values) {
    std::ranges::sort(values);
    return values.at(values.size() / 2);
}

class FarMatchesTest : public testing::TestWithParam<Unit> {};

INSTANTIATE_TEST_SUITE_P(Units, FarMatchesTest, testing::Values(Unit::kTractor, Unit::kTrailer),
                         [](const auto& unit) { return std::string(ToString(unit.param)); });

TEST_P(FarMatchesTest, AlignNeighboursAtInfinityToThreeTenthsOfAPixel) {
    UnitYard yard(GetParam(), 7);
    tests::SurveyBoardsBeforeEach(yard, 0.002);
    yard.Shoot("1");
    UnitProblem& problem = yard.problem();
    std::erase_if(problem.sightings, [](const Sighting& s) {
        return s.target / tests::kBoardsBeforeEach != s.camera;
    });
    const CameraGraph graph = BuildCameraGraph(problem);
    const auto before = SolveUnit(problem, graph);
    ASSERT_TRUE(before);

    problem.far_matches =
        FindFarMatches(problem.cameras, before->places.T_unit_camera, Pictures(GetParam()));
    const auto after = SolveUnitFrom(before->places, problem, graph);
    ASSERT_TRUE(after);

    const auto misaligned = [&](const UnitSolution& solution) {
        return Median(
            MisalignmentAtInfinity(problem, yard.T_unit_camera(), solution.places.T_unit_camera));
    };
    EXPECT_LT(misaligned(*after), 0.3);
    EXPECT_LT(misaligned(*after), misaligned(*before));
    // What a person without the truth sees of it.
    for (const NeighbourMisalignment& pair :
         Misalignments(problem, after->places.T_unit_camera)) {
        EXPECT_LT(pair.median_rad, 2e-3);
    }
}

}  // namespace
}  // namespace hitchview::calib
