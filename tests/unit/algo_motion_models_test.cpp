#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "algo/motion_models.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Similarity {
    using Model = SimilarityModel;
    static constexpr bool kPlane = true;
    static Matrix3d Truth() {
        Matrix3d m;
        const double c = 1.1 * std::cos(0.2);
        const double s = 1.1 * std::sin(0.2);
        m << c, -s, 31, s, c, -12, 0, 0, 1;
        return m;
    }
    /// Small changes of each of the unknowns.
    static std::vector<Matrix3d> Nudges(double by) {
        Matrix3d grow = Matrix3d::Identity();
        grow(0, 0) = grow(1, 1) = 1 + by;
        Matrix3d turn = Matrix3d::Identity();
        turn(0, 1) = -by;
        turn(1, 0) = by;
        Matrix3d right = Matrix3d::Identity();
        right(0, 2) = 300 * by;
        Matrix3d down = Matrix3d::Identity();
        down(1, 2) = 300 * by;
        return {grow, turn, right, down};
    }
};

struct Rotation {
    using Model = RotationModel;
    static constexpr bool kPlane = false;
    static Matrix3d Truth() {
        return Eigen::AngleAxisd(0.4, Vector3d(0.2, -0.3, 0.9).normalized()).toRotationMatrix();
    }
    static std::vector<Matrix3d> Nudges(double by) {
        std::vector<Matrix3d> nudges;
        for (int axis = 0; axis < 3; ++axis) {
            nudges.push_back(Eigen::AngleAxisd(by, Vector3d::Unit(axis)).toRotationMatrix());
        }
        return nudges;
    }
};

struct Homography {
    using Model = HomographyModel;
    static constexpr bool kPlane = true;
    static Matrix3d Truth() {
        Matrix3d m;
        m << 1.05, 0.03, 20, -0.02, 0.97, -9, 1.5e-4, -0.8e-4, 1;
        return m;
    }
};

/// Pairs seen through `truth`, each moved by up to `noise` px (or rad) afterwards.
template <typename World>
std::vector<RayPair> Pairs(int count, double noise, std::uint64_t seed = 5) {
    cv::RNG random(seed);
    std::vector<RayPair> pairs;
    for (int i = 0; i < count; ++i) {
        Vector3d from{random.uniform(0.0, 640.0), random.uniform(0.0, 400.0), 1};
        if (!World::kPlane)
            from = Vector3d{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.3};
        if (!World::kPlane) from.normalize();
        Vector3d to = World::Truth() * from;
        to = World::kPlane ? Vector3d(to / to.z()) : to;
        to.head<2>() +=
            Eigen::Vector2d{random.uniform(-noise, noise), random.uniform(-noise, noise)};
        if (!World::kPlane) to.normalize();
        pairs.push_back({from, to});
    }
    return pairs;
}

std::vector<double> Weights(std::size_t count) {
    std::vector<double> weights;
    for (std::size_t i = 0; i < count; ++i) weights.push_back(0.2 + static_cast<double>(i % 5));
    return weights;
}

template <typename Model>
double WeightedCost(const Matrix3d& m, const std::vector<RayPair>& pairs,
                    const std::vector<double>& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        sum += weights[i] * Model::SquaredResidual(m, pairs[i], 1);
    }
    return sum;
}

template <typename World>
class EveryModelTest : public testing::Test {};
using Worlds = testing::Types<Similarity, Rotation, Homography>;
TYPED_TEST_SUITE(EveryModelTest, Worlds);

TYPED_TEST(EveryModelTest, NoiseFreePairsGiveTheTrueMotion) {
    using Model = typename TypeParam::Model;
    for (const int count : {Model::kMinimal, 5, 60}) {
        const auto pairs = Pairs<TypeParam>(count, 0);
        const auto m = Model::Fit(pairs, Weights(pairs.size()));
        ASSERT_TRUE(m) << count;
        EXPECT_LT((*m - TypeParam::Truth()).cwiseAbs().maxCoeff(), 1e-6) << count << '\n' << *m;
        EXPECT_LT(Model::SquaredResidual(*m, pairs[0], 1), 1e-12);
    }
}

TYPED_TEST(EveryModelTest, PairsOfWeightZeroHaveNoInfluence) {
    using Model = typename TypeParam::Model;
    auto pairs = Pairs<TypeParam>(40, 0);
    std::vector<double> weights(40, 1.0);
    for (std::size_t i = 0; i < 20; ++i) {
        weights[i] = 0;
        pairs[i].to = pairs[39 - i].to;
    }
    const auto m = Model::Fit(pairs, weights);
    ASSERT_TRUE(m);
    EXPECT_LT((*m - TypeParam::Truth()).cwiseAbs().maxCoeff(), 1e-6);
}

TYPED_TEST(EveryModelTest, PairsThatDoNotDetermineTheMotionGiveNone) {
    using Model = typename TypeParam::Model;
    const auto pair = Pairs<TypeParam>(1, 0)[0];
    const std::vector<RayPair> same(10, pair);
    EXPECT_FALSE(Model::Fit(same, Weights(same.size()))) << "one place only";
    const auto good = Pairs<TypeParam>(10, 0);
    EXPECT_FALSE(Model::Fit(good, std::vector<double>(10, 0.0))) << "no weight at all";
}

template <typename World>
class LeastSquaresTest : public testing::Test {};
using LeastSquaresWorlds = testing::Types<Similarity, Rotation>;
TYPED_TEST_SUITE(LeastSquaresTest, LeastSquaresWorlds);

TYPED_TEST(LeastSquaresTest, NoSmallChangeOfTheModelLowersTheWeightedCost) {
    using Model = typename TypeParam::Model;
    const auto pairs = Pairs<TypeParam>(50, TypeParam::kPlane ? 3.0 : 0.02);
    const auto weights = Weights(pairs.size());
    const auto m = Model::Fit(pairs, weights);
    ASSERT_TRUE(m);
    const double cost = WeightedCost<Model>(*m, pairs, weights);
    for (const double by : {1e-3, -1e-3, 1e-5, -1e-5}) {
        for (const Matrix3d& nudge : TypeParam::Nudges(by)) {
            EXPECT_GT(WeightedCost<Model>(nudge * *m, pairs, weights), cost) << nudge;
        }
    }
}

TEST(SimilarityModelTest, IsAlwaysASimilarity) {
    const auto pairs = Pairs<Homography>(30, 5);
    const auto m = SimilarityModel::Fit(pairs, Weights(30));
    ASSERT_TRUE(m);
    EXPECT_DOUBLE_EQ((*m)(0, 0), (*m)(1, 1));
    EXPECT_DOUBLE_EQ((*m)(0, 1), -(*m)(1, 0));
    EXPECT_EQ(m->row(2), Eigen::RowVector3d(0, 0, 1));
}

TEST(RotationModelTest, IsAProperRotationEvenForMirroredPairs) {
    auto pairs = Pairs<Rotation>(30, 0.05);
    for (RayPair& pair : pairs) pair.to.z() *= -1;
    const auto m = RotationModel::Fit(pairs, Weights(30));
    ASSERT_TRUE(m);
    EXPECT_NEAR(m->determinant(), 1, 1e-12);
    EXPECT_LT((*m * m->transpose() - Matrix3d::Identity()).norm(), 1e-12);
}

TEST(RotationModelTest, ResidualsArePixelsOfTheRing) {
    const RayPair pair{Vector3d::UnitX(),
                       Eigen::AngleAxisd(0.01, Vector3d::UnitZ()) * Vector3d::UnitX()};
    EXPECT_NEAR(std::sqrt(RotationModel::SquaredResidual(Matrix3d::Identity(), pair, 300)), 3,
                1e-4);
}

TEST(HomographyModelTest, PointsOnOneLineGiveNone) {
    std::vector<RayPair> pairs;
    for (int i = 0; i < 12; ++i) {
        const Vector3d from{10.0 * i, 5.0 * i + 3, 1};
        const Vector3d to = Homography::Truth() * from;
        pairs.push_back({from, to / to.z()});
    }
    EXPECT_FALSE(HomographyModel::Fit(pairs, Weights(pairs.size())));
}

TEST(HomographyModelTest, MeanResidualOfNoisyPairsIsAboutTheNoise) {
    const auto pairs = Pairs<Homography>(300, 1.0);  // uniform +-1: variance 2/3 px^2
    const std::vector<double> ones(300, 1.0);
    const auto m = HomographyModel::Fit(pairs, ones);
    ASSERT_TRUE(m);
    EXPECT_NEAR(WeightedCost<HomographyModel>(*m, pairs, ones) / 300, 0.667, 0.08);
}

}  // namespace
}  // namespace hitchview::algo
