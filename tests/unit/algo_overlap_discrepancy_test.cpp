#include <gtest/gtest.h>

#include "algo/overlap_discrepancy.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

const Projection kPlane = Projection::Plane(640, 360);
const Projection kRing = Projection::Cylinder(1024, 180, 0.5);
MeasuredDiscrepancy Measure(const Projection& canvas, const CanvasPairs& pairs,
                            double kappa = 0.5) {
    OverlapDiscrepancyOptions options;
    options.kappa = kappa;
    options.propagation = {.radius_px = {50, 60}, .min_votes = 3, .shrink_votes = 3};
    MeasuredDiscrepancy measured;
    OverlapDiscrepancy(canvas, options).Measure(pairs, measured);
    return measured;
}

/// Pairs on a grid of 12 px between two columns; those of the trailer lie `e` farther.
CanvasPairs Pairs(const Projection& canvas, double from_px, double to_px, const Vector2d& e) {
    CanvasPairs pairs;
    for (double x = from_px; x <= to_px; x += 12) {
        for (double y = 4; y < canvas.height_px; y += 12) {
            const Vector2d at{canvas.IsRing() ? WrapColumn(x, canvas.width_px) : x, y};
            Vector2d other = at + e;
            if (canvas.IsRing()) other.x() = WrapColumn(other.x(), canvas.width_px);
            pairs.push_back({at, other});
        }
    }
    return pairs;
}

TEST(OverlapDiscrepancyTest, NoPairsAreNoConfidence) {
    EXPECT_EQ(Measure(kPlane, {}).confidence.maxCoeff(), 0);
}

TEST(OverlapDiscrepancyTest, AConfidentVertexHasTheDiscrepancyOfThePairsAroundIt) {
    const Vector2d e{5, -3};
    const auto found = Measure(kPlane, Pairs(kPlane, 240, 400, e));
    int confident = 0;
    for (int i = 0; i < Mesh::kVertices; ++i) {
        if (!(found.confidence(i) > 0)) continue;
        ++confident;
        EXPECT_GT(found.confidence(i), 0.5F);
        EXPECT_LT((found.field.col(i).cast<double>() - e).norm(), 1e-5);
    }
    EXPECT_GE(confident, 8 * Mesh::kVertexRows);
    EXPECT_EQ(found.confidence(Mesh::Index(5, 2)), 0) << "far from the overlap";
}

TEST(OverlapDiscrepancyTest, OnARingAnOverlapMayLieAcrossTheEdge) {
    const Vector2d e{4, 1};
    const auto found = Measure(kRing, Pairs(kRing, 940, 1100, e));
    for (const int col : {0, 1, 31, 32}) {
        const int i = Mesh::Index(5, col);
        EXPECT_GT(found.confidence(i), 0.5F) << col;
        EXPECT_LT((found.field.col(i).cast<double>() - e).norm(), 1e-4) << col;
    }
}

TEST(OverlapDiscrepancyTest, KappaSaysWhereTheViewsMeet) {
    const Vector2d e{40, 0};
    const auto first = [](const MeasuredDiscrepancy& found) {
        int col = 0;
        while (!(found.confidence(Mesh::Index(5, col)) > 0)) ++col;
        return col;
    };
    const CanvasPairs pairs = Pairs(kPlane, 240, 400, e);
    const int at_tractor = first(Measure(kPlane, pairs, 0));
    const int at_trailer = first(Measure(kPlane, pairs, 1));
    EXPECT_EQ(at_trailer - at_tractor, 2) << "40 px are two cells";
}

TEST(OverlapDiscrepancyTest, AnObliquePlaneIsFollowedToTheRimOfTheOverlap) {
    CanvasPairs pairs = Pairs(kPlane, 240, 400, {0, 0});
    const auto gap = [](const Vector2d& at) {
        return Vector2d{6 + 0.03 * (at.x() - 320), -2 + 0.02 * (at.y() - 180)};
    };
    for (CanvasPair& pair : pairs) {
        const Vector2d e = gap(pair.tractor_px);
        pair.tractor_px -= 0.5 * e;
        pair.trailer_px += 0.5 * e;
    }
    const auto found = Measure(kPlane, pairs);
    const Mesh mesh(kPlane);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            const int i = Mesh::Index(row, col);
            if (!(found.confidence(i) > 0)) continue;
            const Vector2d error = found.field.col(i).cast<double>() - gap(mesh.Vertex(row, col));
            EXPECT_LT(error.norm(), 0.1) << row << ' ' << col;
        }
    }
}

TEST(OverlapDiscrepancyTest, ASecondOverlapIsAddedToTheFirst) {
    OverlapDiscrepancyOptions options;
    options.propagation = {.radius_px = {50, 60}, .min_votes = 3, .shrink_votes = 3};
    OverlapDiscrepancy sut(kRing, options);
    MeasuredDiscrepancy measured;
    sut.Measure(Pairs(kRing, 200, 320, {7, 0}), measured);
    sut.Measure(Pairs(kRing, 700, 820, {-5, 2}), measured);
    EXPECT_NEAR(measured.field(0, Mesh::Index(5, 8)), 7, 1e-3);
    EXPECT_NEAR(measured.field(0, Mesh::Index(5, 24)), -5, 1e-3);
}

}  // namespace
}  // namespace hitchview::algo
