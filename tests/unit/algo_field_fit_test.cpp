#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "algo/field_fit.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

const Projection kPlane = Projection::Plane(640, 320);
const Projection kRing = Projection::Cylinder(640, 160, 0.5);

std::vector<PointMotion> SamplesIn(const Projection& canvas, int count, std::uint64_t seed,
                                   auto&& motion) {
    cv::RNG random(seed);
    std::vector<PointMotion> samples;
    for (int i = 0; i < count; ++i) {
        const Vector2d at{random.uniform(0.0, canvas.width_px - 1.0),
                          random.uniform(0.0, canvas.height_px - 1.0)};
        samples.push_back({at, motion(at)});
    }
    return samples;
}

/// Fits with enough sweeps for the answer to be the minimum.
struct Fitted {
    VertexField field = VertexField::Zero();
    VertexScalars support = VertexScalars::Zero();

    Fitted(const Projection& canvas, const std::vector<PointMotion>& samples,
           FieldFitOptions options, const VertexField& predicted = VertexField::Zero(),
           const VertexScalars& confidence = VertexScalars::Zero()) {
        options.sweeps = 3000;
        const auto fit = std::make_unique<FieldFit>(Mesh(canvas), options);
        field = predicted;
        fit->Fit(samples, predicted, confidence, field, support);
    }
};

/// The stated energy of the x component with all samples at weight 1, as one dense system.
Eigen::VectorXd DenseMinimum(const Mesh& mesh, const std::vector<PointMotion>& samples,
                             const FieldFitOptions& options) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(Mesh::kVertices, Mesh::kVertices);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(Mesh::kVertices);
    Eigen::VectorXd support = Eigen::VectorXd::Zero(Mesh::kVertices);
    for (const PointMotion& sample : samples) {
        const MeshPlace place = Locate(mesh, sample.at_px);
        Eigen::VectorXd row = Eigen::VectorXd::Zero(Mesh::kVertices);
        for (std::size_t k = 0; k < 4; ++k)
            row(place.vertex[k]) = static_cast<double>(place.share[k]);
        normal += row * row.transpose();
        right += sample.motion_px.x() * row;
        support += row;
    }
    const double w = mesh.cell_px.x();
    const double h = mesh.cell_px.y();
    const auto edge = [&](int a, int b, double pull) {
        normal(a, a) += pull;
        normal(b, b) += pull;
        normal(a, b) -= pull;
        normal(b, a) -= pull;
    };
    for (int r = 0; r < Mesh::kVertexRows; ++r) {
        for (int c = 0; c < Mesh::kVertexCols; ++c) {
            const int i = Mesh::Index(r, c);
            if (c < Mesh::kCols) edge(i, i + 1, options.smoothness * h / w);
            if (r < Mesh::kRows) edge(i, i + Mesh::kVertexCols, options.smoothness * w / h);
            normal(i, i) += options.smoothness * w * h / (options.fade_px * options.fade_px) /
                            (1 + 4 * support(i));
        }
    }
    return normal.ldlt().solve(right);
}

TEST(FieldFitTest, IsTheMinimumOfTheStatedEnergy) {
    cv::RNG random(5);
    const auto samples = SamplesIn(kPlane, 150, 1, [&](const Vector2d& at) {
        const double step = at.x() > 200 && at.x() < 400 ? 6.0 : 2.0;
        return Vector2d{step + random.gaussian(0.5), 0};
    });
    // Outliers so far off that every sample has weight 1.
    const FieldFitOptions options{.outlier_px = 1e4, .start_outlier_px = 1e4};
    const Fitted fitted(kPlane, samples, options);
    const Eigen::VectorXd dense = DenseMinimum(Mesh(kPlane), samples, options);
    for (int i = 0; i < Mesh::kVertices; ++i) EXPECT_NEAR(fitted.field(0, i), dense(i), 2e-3) << i;
}

TEST(FieldFitTest, AThirdOfWildSamplesHasNoSay) {
    cv::RNG random(7);
    const auto samples = SamplesIn(kPlane, 1200, 2, [&](const Vector2d& at) {
        if (random.uniform(0.0, 1.0) < 0.33)
            return Vector2d{random.uniform(-40.0, 40.0), random.uniform(-40.0, 40.0)};
        return Vector2d{0.01 * at.x(), -2};
    });
    const Fitted fitted(kPlane, samples, {});
    for (double x = 60; x < 600; x += 30) {
        for (double y = 40; y < 300; y += 30) {
            const Vector2d e = Sample(Mesh(kPlane), fitted.field, {x, y});
            EXPECT_LT((e - Vector2d{0.01 * x, -2}).norm(), 0.5) << x << ' ' << y;
        }
    }
}

TEST(FieldFitTest, APredictionHoldsWhereNoSamplesAreAndOnlyAsFarAsItIsTrusted) {
    VertexField predicted = VertexField::Zero();
    predicted.row(0).setConstant(5);
    VertexScalars trusted = VertexScalars::Constant(1);
    EXPECT_NEAR(Fitted(kPlane, {}, {}, predicted, trusted).field(0, 100), 5, 0.2);
    EXPECT_NEAR(Fitted(kPlane, {}, {}, predicted, VertexScalars::Zero()).field(0, 100), 0, 1e-3);
}

TEST(FieldFitTest, ARingHasNoEdge) {
    std::vector<PointMotion> samples;
    for (double x = -60; x <= 60; x += 5) {
        for (double y = 5; y < 155; y += 10)
            samples.push_back({{WrapColumn(x, kRing.width_px), y}, {4, 1}});
    }
    const Fitted fitted(kRing, samples, {.fade_px = 40});
    for (const double x : {-30.0, -0.5, 0.0, 30.0}) {
        const Vector2d at{WrapColumn(x, kRing.width_px), 80};
        EXPECT_LT((Sample(Mesh(kRing), fitted.field, at) - Vector2d{4, 1}).norm(), 0.1) << x;
    }
    EXPECT_LT(Sample(Mesh(kRing), fitted.field, {320, 80}).norm(), 0.1);
}

TEST(FieldFitTest, SupportTellsWhereSamplesWere) {
    const Fitted fitted(kPlane, {{{320, 160}, {1, 0}}}, {});
    EXPECT_NEAR(fitted.support.sum(), 1, 0.05);
    const MeshPlace place = Locate(Mesh(kPlane), {320, 160});
    EXPECT_GT(fitted.support(place.vertex[0]) + fitted.support(place.vertex[1]) +
                  fitted.support(place.vertex[2]) + fitted.support(place.vertex[3]),
              0.999 * fitted.support.sum());
}

}  // namespace
}  // namespace hitchview::algo
