#include <gtest/gtest.h>

#include "calib/moved_cameras.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector3d;

constexpr double kLimit_rad = 0.004;

/// What a pair sees of turns of its cameras, up to errors well below the limit.
PairTurn Pair(std::size_t first, std::size_t second, const std::vector<Vector3d>& turns) {
    const Vector3d ahead(1, 0.1 * static_cast<double>(first), 0);
    const Vector3d d = ahead.normalized();
    return {.first = first,
            .second = second,
            .turn_rad = turns[second] - turns[first] + Vector3d(0.0008, -0.0005, 0.0006),
            .shown = Eigen::Matrix3d::Identity() - 0.95 * d * d.transpose()};
}

std::vector<PairTurn> Row(const std::vector<Vector3d>& turns) {
    std::vector<PairTurn> pairs;
    for (std::size_t i = 0; i + 1 < turns.size(); ++i) pairs.push_back(Pair(i, i + 1, turns));
    return pairs;
}

TEST(MovedCamerasTest, NobodyMovedWhereAllAgree) {
    const auto answers =
        ExplainByMoves(5, Row(std::vector<Vector3d>(5, Vector3d::Zero())), kLimit_rad);
    ASSERT_EQ(answers.size(), 1);
    EXPECT_TRUE(answers[0].empty());
}

TEST(MovedCamerasTest, ACameraInTheMiddleIsFoundByItsTwoNeighbours) {
    std::vector<Vector3d> turns(5, Vector3d::Zero());
    turns[2] = Vector3d(0, 0.02, 0.01);
    const auto answers = ExplainByMoves(5, Row(turns), kLimit_rad);
    ASSERT_EQ(answers.size(), 1);
    ASSERT_EQ(answers[0].size(), 1);
    EXPECT_EQ(answers[0][0].camera, 2);
    EXPECT_NEAR(answers[0][0].turn_rad, turns[2].norm(), 0.005);
}

TEST(MovedCamerasTest, AtTheEndOfARowTheNeighbourCouldHaveMovedOnlyIfNobodyElseSeesIt) {
    std::vector<Vector3d> turns(2, Vector3d::Zero());
    turns[1] = Vector3d(0, 0.03, 0);
    EXPECT_EQ(ExplainByMoves(2, Row(turns), kLimit_rad).size(), 2);

    turns.assign(4, Vector3d::Zero());
    turns[3] = Vector3d(0, 0.03, 0);
    const auto answers = ExplainByMoves(4, Row(turns), kLimit_rad);
    ASSERT_EQ(answers.size(), 1);
    EXPECT_EQ(answers[0][0].camera, 3);
}

TEST(MovedCamerasTest, TwoThatMovedAreBothNamed) {
    std::vector<Vector3d> turns(6, Vector3d::Zero());
    turns[1] = Vector3d(0, 0.03, 0);
    turns[4] = Vector3d(0, 0, -0.03);
    auto pairs = Row(turns);
    pairs.push_back(Pair(0, 5, turns));  // a closed ring
    const auto answers = ExplainByMoves(6, pairs, kLimit_rad);
    ASSERT_EQ(answers.size(), 1);
    ASSERT_EQ(answers[0].size(), 2);
    EXPECT_EQ(answers[0][0].camera, 1);
    EXPECT_EQ(answers[0][1].camera, 4);
}

TEST(MovedCamerasTest, ARingThatDoesNotCloseIsNotExplained) {
    std::vector<PairTurn> pairs;
    const std::vector<Vector3d> still(8, Vector3d::Zero());
    for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t j = i + 1; j < 8; ++j) {
            pairs.push_back(Pair(i, j, still));
            pairs.back().turn_rad += Vector3d(0, 0.02, 0) * static_cast<double>(i * j % 5);
        }
    EXPECT_TRUE(ExplainByMoves(8, pairs, kLimit_rad).empty());
}

}  // namespace
}  // namespace hitchview::calib
