#include <gtest/gtest.h>

#include <random>

#include "calib/moved_cameras.hpp"
#include "calib/reprojection_error.hpp"

namespace hitchview::calib {
namespace {

using Eigen::Vector3d;

constexpr double kLimit_rad = 0.004;

/// What a pair 1 m apart sees of things from 12 m on when its cameras are turned; the turn that it
/// suggests has errors well below the limit.
PairTurn Pair(std::size_t first, std::size_t second, const std::vector<Vector3d>& turns) {
    std::mt19937 random(static_cast<unsigned>(10 * first + second));
    std::uniform_real_distribution<double> any(-1, 1);
    PairTurn pair{.first = first, .second = second, .baseline_m = {0.3, 0.2, 0.9}};
    for (int i = 0; i < 60; ++i) {
        const double distance_m = 12 * std::exp(2 + 2 * any(random));
        const double z = 0.3 * any(random);
        const double y = 0.5 * any(random);
        const Vector3d p = distance_m * Vector3d(1, y, z);
        pair.sights.push_back(
            {Rotation(turns[first]).transpose() * p.normalized(),
             Rotation(turns[second]).transpose() * (p + pair.baseline_m).normalized()});
    }
    pair.turn_rad = turns[second] - turns[first] + 0.0006 * Vector3d(1, -1, 1);
    return pair;
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
    for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t j = i + 1; j < 8; ++j) {
            std::vector<Vector3d> turns(8, Vector3d::Zero());
            turns[j] = Vector3d(0, 0.02, 0) * static_cast<double>(i * j % 5);
            pairs.push_back(Pair(i, j, turns));
        }
    }
    EXPECT_TRUE(ExplainByMoves(8, pairs, kLimit_rad).empty());
}

}  // namespace
}  // namespace hitchview::calib
