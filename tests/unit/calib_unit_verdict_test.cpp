#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/unit_changes.hpp"
#include "calib/unit_verdict.hpp"
#include "tests/support/unit_yard.hpp"

namespace hitchview::calib {
namespace {

using algo::Unit;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::UnitYard;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSurvey_m = 0.002;

Eigen::Isometry3d Nudge(double turn_deg, double shift_m) {
    Eigen::Isometry3d nudge = Eigen::Isometry3d::Identity();
    nudge.linear() = Eigen::AngleAxisd(turn_deg * kDegree, Eigen::Vector3d(1, 2, 0).normalized())
                         .toRotationMatrix();
    nudge.translation() = shift_m * Eigen::Vector3d(0.6, 0, 0.8);
    return nudge;
}

/// A tractor with surveyed boards and four shots of them.
class UnitVerdictTest : public testing::Test {
 protected:
    UnitVerdictTest() : yard_(Unit::kTractor, 5) {
        tests::SurveyBoardsBeforeEach(yard_, kSurvey_m);
    }

    void Shoot(const std::string& first, const std::string& second) {
        yard_.Shoot(first);
        yard_.Shoot(second);
    }

    std::vector<std::string> Judge() {
        const CameraGraph graph = BuildCameraGraph(yard_.problem());
        EXPECT_THAT(graph.missing, IsEmpty());
        const auto solution = SolveUnit(yard_.problem(), graph);
        if (!solution) return {"no solution"};
        return JudgeUnit(yard_.problem(), graph, *solution);
    }

    UnitYard yard_;
};

TEST_F(UnitVerdictTest, FindsNothingWrongWhereNothingIs) {
    Shoot("1", "2");
    Shoot("3", "4");
    EXPECT_THAT(Judge(), IsEmpty());
}

TEST_F(UnitVerdictTest, NamesTwoCamerasWhosePicturesWereSwapped) {
    Shoot("1", "2");
    std::swap(yard_.problem().cameras[1].yaw_rad, yard_.problem().cameras[2].yaw_rad);
    EXPECT_THAT(Judge(),
                ElementsAre(HasSubstr("are the pictures of left_front and right_front swapped?")));
}

TEST_F(UnitVerdictTest, NamesACameraThatLooksElsewhere) {
    Shoot("1", "2");
    yard_.problem().cameras[1].yaw_rad = 160 * kDegree;
    EXPECT_THAT(
        Judge(),
        ElementsAre(HasSubstr("left_front looks to 70 degrees, but its yaw was said to be 160")));
}

TEST_F(UnitVerdictTest, NamesACameraThatMovedAndWhen) {
    Shoot("1", "2");
    yard_.T_unit_camera()[1] = yard_.T_unit_camera()[1] * Nudge(0.3, 0.01);
    Shoot("3", "4");
    EXPECT_THAT(Judge(),
                Contains(HasSubstr("camera left_front moved between the shots 2 and 3, by 0.3")));
}

TEST_F(UnitVerdictTest, NamesATargetThatMovedAndWhen) {
    // Seen by two cameras: else it could as well be the camera.
    const auto between = UnitYard::Standing({5, 3, 0.5}, {1, 0.3, 1.3}, 0.4);
    const std::size_t shared = yard_.AddTarget(between);
    Shoot("1", "2");
    yard_.Shoot("3");
    yard_.T_unit_target()[shared] = Nudge(0, 0.04) * yard_.T_unit_target()[shared];
    yard_.Shoot("4");
    const auto reasons = Judge();
    EXPECT_THAT(reasons, Contains(HasSubstr("target " + yard_.problem().targets[shared].name +
                                            " moved between the shots 3 and 4")));
    EXPECT_THAT(reasons, testing::Not(Contains(HasSubstr("camera"))));
}

TEST_F(UnitVerdictTest, NamesBothWhereNobodyCanTellWhichOfTwoMoved) {
    Shoot("1", "2");
    yard_.T_unit_camera()[1] = yard_.T_unit_camera()[1] * Nudge(0.5, 0);
    Shoot("3", "4");
    // The camera sees one target, which nobody else sees.
    constexpr std::size_t kFirstOfSecondCamera = tests::kBoardsBeforeEach;
    std::erase_if(yard_.problem().sightings, [](const Sighting& s) {
        return (s.camera == 1) != (s.target == kFirstOfSecondCamera);
    });
    const auto reasons = Judge();
    EXPECT_THAT(reasons,
                Contains(testing::AllOf(HasSubstr("moved between the shots 2 and 3"),
                                        HasSubstr("left_front"), HasSubstr("(or it was "))));
}

TEST_F(UnitVerdictTest, NamesABoardThatIsNotAsLargeAsWasSaid) {
    Shoot("1", "2");
    for (Sighting& sighting : yard_.problem().sightings)
        ASSERT_EQ(yard_.problem().targets[sighting.target].board, tests::kYardBoard);
    yard_.problem().targets[0].board.square_m *= 1.02;
    yard_.problem().targets[0].board.tag_m *= 1.02;
    const auto reasons = Judge();
    EXPECT_THAT(reasons, Contains(HasSubstr("target0 is 1.9 % smaller than its board says")));
}

TEST_F(UnitVerdictTest, NamesASightingThatDoesNotFit) {
    Shoot("1", "2");
    Shoot("3", "4");
    Sighting& sighting = yard_.problem().sightings.at(2);
    for (SeenCorner& corner : sighting.corners) corner.at_px.x() += 9;
    EXPECT_THAT(Judge(), Contains(HasSubstr("in shot " + sighting.shot + " of ")));
}

TEST_F(UnitVerdictTest, NamesASurveyedCornerThatIsWrong) {
    Shoot("1", "2");
    yard_.problem().targets[0].surveyed[2].p_unit_m.z() += 0.05;
    EXPECT_THAT(Judge(), Contains(HasSubstr("surveyed corner 3 of target0 is ")));
}

TEST_F(UnitVerdictTest, NamesAMeasuredPoseThatIsWrong) {
    Shoot("1", "2");
    yard_.problem().cameras[0].pose =
        MeasuredPose{Nudge(0, 0.2) * yard_.T_unit_camera()[0], 0.01, 0.02};
    EXPECT_THAT(Judge(), Contains(HasSubstr("the measured pose of front is ")));
}

TEST_F(UnitVerdictTest, SaysWhatIsNotKnownWellEnough) {
    Shoot("1", "2");
    for (UnitTarget& target : yard_.problem().targets) target.sigma_m = 0.02;
    const auto reasons = Judge();
    EXPECT_EQ(reasons.size(), 3U);
    EXPECT_THAT(reasons, Contains(HasSubstr("front is known to ")));
}

TEST_F(UnitVerdictTest, NamesACameraWithTooFewCorners) {
    Shoot("1", "2");
    auto& sightings = yard_.problem().sightings;
    std::erase_if(sightings, [&](const Sighting& s) { return s.camera == 0 && s.target != 0; });
    for (Sighting& sighting : sightings) {
        if (sighting.camera == 0) sighting.corners.resize(8);
    }
    EXPECT_THAT(Judge(), Contains(HasSubstr("front has 16 corners that fit")));
}

}  // namespace
}  // namespace hitchview::calib
