#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

#include "algo/magsac.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kCapacity = 400;
using Pairs = MagsacEstimator<SimilarityModel, kCapacity>::Pairs;

Matrix3d Homography() {
    Matrix3d m;
    m << 1.04, 0.05, 14, -0.03, 0.98, -8, 1e-4, 0.5e-4, 1;
    return m;
}

Matrix3d Similarity() {
    Matrix3d m;
    m << 0.99, -0.1, 25, 0.1, 0.99, -7, 0, 0, 1;
    return m;
}

/// Plane pairs: a share that follows `truth` with Gaussian noise, the rest anywhere. Good ones
/// first.
Pairs PlanePairs(const Matrix3d& truth, int count, double outliers, double noise_px,
                 std::uint64_t seed = 11) {
    cv::RNG random(seed);
    Pairs pairs;
    const auto good = static_cast<int>(std::lround(count * (1 - outliers)));
    for (int i = 0; i < count; ++i) {
        const Vector3d from{random.uniform(0.0, 640.0), random.uniform(0.0, 400.0), 1};
        Vector2d to{random.uniform(0.0, 640.0), random.uniform(0.0, 400.0)};
        if (i < good) {
            to = (truth * from).hnormalized() +
                 Vector2d{random.gaussian(noise_px), random.gaussian(noise_px)};
        }
        pairs.push_back({from, to.homogeneous()});
    }
    return pairs;
}

/// Root mean square distance of the model from the noise-free truth over the picture.
double ModelError(const Matrix3d& m, const Matrix3d& truth) {
    double sum = 0;
    int count = 0;
    for (double x = 0; x <= 640; x += 80) {
        for (double y = 0; y <= 400; y += 80, ++count) {
            const Vector3d p{x, y, 1};
            sum += ((m * p).hnormalized() - (truth * p).hnormalized()).squaredNorm();
        }
    }
    return std::sqrt(sum / count);
}

TEST(MagsacCostTest, TheWeightFallsFromOneToZeroAtTheCutOff) {
    const MagsacCost cost(1.5);
    EXPECT_DOUBLE_EQ(cost.Weight(0), 1);
    double last = 1;
    for (double r = 0.01; r < cost.cutoff_px(); r += 0.01) {
        EXPECT_LE(cost.Weight(r * r), last) << r;
        last = cost.Weight(r * r);
    }
    EXPECT_NEAR(last, 0, 1e-3);
    EXPECT_EQ(cost.Weight(1e12), 0);
    EXPECT_EQ(cost.Cost(0), 0);
    EXPECT_EQ(cost.Cost(1e12), 1);
}

TEST(MagsacCostTest, TheWeightIsTheDensityOfTheResidualAveragedOverAllNoiseLevels) {
    constexpr double kLargest = 2.0;
    const MagsacCost cost(kLargest);
    // Density r / s^2 exp(-r^2 / 2 s^2) of a 2-D residual at noise level s, cut at 3.03 s.
    const auto averaged = [&](double r) {
        constexpr int kSteps = 100000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double s = kLargest * (i + 0.5) / kSteps;
            if (r < 3.0349 * s) sum += r / (s * s) * std::exp(-r * r / (2 * s * s));
        }
        return sum / kSteps;
    };
    const double scale = cost.Weight(0.25) / averaged(0.5);
    for (const double r : {0.1, 1.0, 2.0, 3.0, 4.5, 5.8}) {
        EXPECT_NEAR(cost.Weight(r * r), scale * averaged(r), 1e-3) << r;
    }
}

TEST(MagsacCostTest, TheSlopeOfTheCostIsTheResidualTimesItsWeight) {
    const MagsacCost cost(1.2);
    const auto slope = [&](double r) {
        const double h = 0.05;
        return (cost.Cost((r + h) * (r + h)) - cost.Cost((r - h) * (r - h))) / (2 * h);
    };
    const double scale = slope(1.0) / (1.0 * cost.Weight(1.0));
    for (double r = 0.2; r < cost.cutoff_px() - 0.1; r += 0.1) {
        EXPECT_NEAR(slope(r), scale * r * cost.Weight(r * r), 5e-3) << r;
    }
}

TEST(MagsacTest, FindsASimilarityAmongSixtyPercentOutliers) {
    MagsacEstimator<SimilarityModel, kCapacity> estimator({.max_sigma_px = 1.5});
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto fit = estimator.Fit(PlanePairs(Similarity(), 150, 0.6, 0.5, seed));
        ASSERT_TRUE(fit) << seed;
        EXPECT_LT(ModelError(fit->model, Similarity()), 0.5) << seed;
        EXPECT_NEAR(fit->inliers, 60, 8) << seed;
    }
}

TEST(MagsacTest, FindsARotationAmongSixtyPercentOutliers) {
    MagsacEstimator<RotationModel, kCapacity> estimator({.max_sigma_px = 1.5});
    const Matrix3d truth =
        Eigen::AngleAxisd(0.3, Vector3d(0.1, 0.2, 1).normalized()).toRotationMatrix();
    cv::RNG random(3);
    const auto any_ray = [&random] {
        return Vector3d(random.gaussian(1), random.gaussian(1), random.gaussian(0.3)).normalized();
    };
    Pairs pairs;
    for (int i = 0; i < 150; ++i) {
        const Vector3d from = any_ray();
        const Vector3d noise = any_ray() * random.gaussian(1.0 / 300);
        pairs.push_back({from, i < 60 ? (truth * from + noise).normalized() : any_ray()});
    }
    const auto fit = estimator.Fit(pairs, 300);
    ASSERT_TRUE(fit);
    const double error_rad = Eigen::AngleAxisd(fit->model * truth.transpose()).angle();
    EXPECT_LT(error_rad * 300, 0.5);
}

TEST(MagsacTest, FindsAHomographyAsWellAsOpenCvsMagsac) {
    MagsacEstimator<HomographyModel, kCapacity> estimator(
        {.max_sigma_px = 1.5, .max_iterations = 1000});
    double ours = 0;
    double theirs = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Pairs pairs = PlanePairs(Homography(), 200, 0.6, 0.7, seed);
        const auto fit = estimator.Fit(pairs);
        ASSERT_TRUE(fit) << seed;
        std::vector<cv::Point2d> from;
        std::vector<cv::Point2d> to;
        for (const RayPair& pair : pairs) {
            from.emplace_back(pair.from.x(), pair.from.y());
            to.emplace_back(pair.to.x(), pair.to.y());
        }
        const cv::Matx33d h =
            cv::findHomography(from, to, cv::USAC_MAGSAC, 3.0, cv::noArray(), 5000, 0.999);
        Matrix3d oracle;
        oracle << h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1), h(2, 2);
        for (std::size_t i = 0; i < 80; ++i) {
            ours += HomographyModel::SquaredResidual(fit->model, pairs[i], 1);
            theirs += HomographyModel::SquaredResidual(oracle, pairs[i], 1);
        }
    }
    EXPECT_LE(std::sqrt(ours), 1.1 * std::sqrt(theirs));
}

TEST(MagsacTest, TheSamePairsAndSeedGiveTheSameAnswerBitForBit) {
    MagsacEstimator<HomographyModel, kCapacity> estimator({});
    const Pairs pairs = PlanePairs(Homography(), 120, 0.5, 1.0);
    const auto first = estimator.Fit(pairs);
    estimator.Fit(PlanePairs(Similarity(), 90, 0.3, 0.5));
    const auto again = estimator.Fit(pairs);
    MagsacEstimator<HomographyModel, kCapacity> other({});
    const auto elsewhere = other.Fit(pairs);
    ASSERT_TRUE(first && again && elsewhere);
    EXPECT_EQ(first->model, again->model);
    EXPECT_EQ(first->model, elsewhere->model);
}

/// Counts how often it is fitted.
struct CountingModel : SimilarityModel {
    static inline int fits = 0;
    static std::optional<Matrix3d> Fit(std::span<const RayPair> pairs, std::span<const double> w) {
        ++fits;
        return SimilarityModel::Fit(pairs, w);
    }
};

TEST(MagsacTest, TheNumberOfFitsIsBoundedWhateverThePairs) {
    MagsacEstimator<CountingModel, kCapacity> estimator({.max_iterations = 100, .polish_steps = 4});
    CountingModel::fits = 0;
    estimator.Fit(PlanePairs(Similarity(), 300, 1.0, 0));
    // Each sample may be polished twice, and the best one at the end.
    EXPECT_LE(CountingModel::fits, 3 * 100 + 4);
    EXPECT_GE(CountingModel::fits, 100);

    CountingModel::fits = 0;
    estimator.Fit(PlanePairs(Similarity(), 300, 0.0, 0.1));
    EXPECT_LT(CountingModel::fits, 30) << "clean pairs need few samples";
}

TEST(MagsacTest, PairsThatAgreeOnNothingGiveNoModelOrOneOfFewInliers) {
    MagsacEstimator<SimilarityModel, kCapacity> estimator({.max_sigma_px = 1});
    const auto fit = estimator.Fit(PlanePairs(Similarity(), 100, 1.0, 0));
    EXPECT_TRUE(!fit || fit->inliers < 10);
}

TEST(MagsacTest, TooFewPairsGiveNoModel) {
    MagsacEstimator<SimilarityModel, kCapacity> similarity({});
    MagsacEstimator<HomographyModel, kCapacity> homography({});
    EXPECT_FALSE(similarity.Fit({}));
    EXPECT_FALSE(similarity.Fit(PlanePairs(Similarity(), 3, 0, 0)));
    EXPECT_TRUE(similarity.Fit(PlanePairs(Similarity(), 4, 0, 0)));
    EXPECT_FALSE(homography.Fit(PlanePairs(Similarity(), 5, 0, 0)));
    EXPECT_TRUE(homography.Fit(PlanePairs(Similarity(), 6, 0, 0)));
}

TEST(MagsacTest, PairsAllInOnePlaceGiveNoModel) {
    MagsacEstimator<SimilarityModel, kCapacity> estimator({});
    Pairs pairs;
    for (int i = 0; i < 20; ++i) pairs.push_back({{5, 5, 1}, {9, 9, 1}});
    EXPECT_FALSE(estimator.Fit(pairs));
}

}  // namespace
}  // namespace hitchview::algo
