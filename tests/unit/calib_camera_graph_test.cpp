#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "calib/camera_graph.hpp"

namespace hitchview::calib {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Board kBoard{.columns = 4, .rows = 3, .square_m = 0.2};

/// Front, left and rear; targets by name.
UnitProblem Cameras() {
    UnitProblem problem;
    for (const auto& [name, yaw_deg] : {std::pair{"front", 0}, {"left", 70}, {"rear", 180}})
        problem.cameras.push_back({.name = name, .yaw_rad = yaw_deg * std::numbers::pi / 180});
    return problem;
}

void AddTarget(UnitProblem& problem, const std::string& name, int surveyed = 0,
               bool moves = false) {
    UnitTarget target{.name = name, .board = kBoard, .moves = moves};
    for (const int corner : {0, 3, 8}) {
        if (surveyed-- > 0) target.surveyed.push_back({.p_board_m = kBoard.Corner(corner)});
    }
    problem.targets.push_back(target);
}

void See(UnitProblem& problem, std::size_t camera, std::size_t target,
         const std::string& shot = "1", int corners = 12) {
    Sighting sighting{camera, target, shot, {}};
    for (int i = 0; i < corners; ++i) sighting.corners.push_back({.index = i});
    problem.sightings.push_back(sighting);
}

TEST(CameraGraphTest, IsCompleteWhereEachCameraSeesASurveyedTargetOfItsOwn) {
    UnitProblem problem = Cameras();
    for (std::size_t i = 0; i < 3; ++i) {
        AddTarget(problem, "post" + std::to_string(i), 3);
        See(problem, i, i);
    }
    const CameraGraph graph = BuildCameraGraph(problem);
    EXPECT_THAT(graph.missing, IsEmpty());
    EXPECT_EQ(graph.nodes.size(), 3U);
    EXPECT_EQ(graph.text,
              "unit frame: post0 (3 corners) post1 (3 corners) post2 (3 corners)\n"
              "front:  post0 (1 pictures, 12 corners)\n"
              "left:  post1 (1 pictures, 12 corners)\n"
              "rear:  post2 (1 pictures, 12 corners)\n");
}

TEST(CameraGraphTest, IsCompleteWhereTargetsLeadFromAMeasuredCameraToTheOthers) {
    UnitProblem problem = Cameras();
    AddTarget(problem, "gate");
    AddTarget(problem, "carried", 0, true);
    problem.cameras[0].pose = MeasuredPose{};
    See(problem, 0, 0);
    See(problem, 1, 0);
    See(problem, 1, 1, "2");
    See(problem, 2, 1, "2");
    EXPECT_THAT(BuildCameraGraph(problem).missing, IsEmpty());
}

TEST(CameraGraphTest, NamesTheNeighboursBetweenWhichATargetIsMissing) {
    UnitProblem problem = Cameras();
    AddTarget(problem, "gate", 3);
    AddTarget(problem, "post");
    See(problem, 0, 0);
    See(problem, 1, 1);
    See(problem, 2, 1);
    EXPECT_THAT(BuildCameraGraph(problem).missing,
                ElementsAre("left, rear hang together, but on nothing that was surveyed or "
                            "measured: put a target where left and front both see it, or survey "
                            "three corners of post"));
}

TEST(CameraGraphTest, AMovingTargetLinksCamerasInOneShotOnly) {
    UnitProblem problem = Cameras();
    AddTarget(problem, "gate", 3);
    AddTarget(problem, "carried", 0, true);
    See(problem, 0, 0);
    See(problem, 0, 1, "1");
    See(problem, 1, 1, "2");
    See(problem, 2, 1, "1");
    const CameraGraph graph = BuildCameraGraph(problem);
    EXPECT_EQ(graph.nodes.size(), 3U);
    EXPECT_THAT(graph.missing, ElementsAre(HasSubstr("left hangs on nothing")));
}

TEST(CameraGraphTest, NamesACameraThatSeesNothing) {
    UnitProblem problem = Cameras();
    AddTarget(problem, "gate", 3);
    See(problem, 0, 0);
    See(problem, 1, 0);
    EXPECT_THAT(BuildCameraGraph(problem).missing,
                ElementsAre(HasSubstr("rear sees no target in any picture")));
}

TEST(CameraGraphTest, SaysThatTheUnitFrameIsNotFixed) {
    UnitProblem problem = Cameras();
    AddTarget(problem, "gate", 2);
    for (std::size_t i = 0; i < 3; ++i) See(problem, i, 0);
    EXPECT_THAT(BuildCameraGraph(problem).missing,
                testing::Contains(HasSubstr("the unit frame is not fixed")));
}

TEST(CameraGraphTest, ASightingWithTooFewCornersIsNoLinkAndIsNamed) {
    UnitProblem problem = Cameras();
    AddTarget(problem, "gate", 3);
    See(problem, 0, 0);
    See(problem, 1, 0, "1", 5);
    See(problem, 2, 0, "1", 4);  // one row
    const CameraGraph graph = BuildCameraGraph(problem);
    EXPECT_THAT(graph.notes, ElementsAre(HasSubstr("left sees too little of gate in 1: 5 corners"),
                                         HasSubstr("rear sees too little of gate in 1")));
    EXPECT_EQ(graph.missing.size(), 2U);
}

}  // namespace
}  // namespace hitchview::calib
