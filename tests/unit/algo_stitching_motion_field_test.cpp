#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core.hpp>

#include "algo/stitching_motion_field.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

const Projection kPlane = Projection::Plane(1280, 400);
const Projection kRing = Projection::Cylinder(1280, 240, 0.5);

const FieldFitOptions kFit{.fade_px = 70};

/// Pairs in columns x0..x1 whose trailer point lies at the tractor point + e(tractor point).
template <typename Discrepancy>
CanvasPairs PairsIn(const Projection& canvas, double x0, double x1, Discrepancy&& e) {
    CanvasPairs pairs;
    for (double y = 8; y < canvas.height_px; y += 22) {
        for (double x = x0; x <= x1; x += 22) {
            const Vector2d at{WrapColumn(x, canvas.width_px), y};
            Vector2d to = at + e(at);
            if (canvas.IsRing()) to.x() = WrapColumn(to.x(), canvas.width_px);
            pairs.push_back({at, to});
        }
    }
    return pairs;
}

void Converge(StitchingMotionField& field, const CanvasPairs& pairs, int frames = 60) {
    for (int i = 0; i < frames; ++i) {
        field.Update(pairs);
        field.Extend();
    }
}

/// Smallest determinant of canvas -> place where a unit's pixels are read, over both units.
double SmallestJacobian(const StitchingMotionField& field, const Projection& canvas) {
    constexpr double kStep = 0.25;
    double smallest = 1e9;
    for (double y = 1; y < canvas.height_px - 2; y += 7.3) {
        for (double x = 1; x < canvas.width_px - 2; x += 7.3) {
            const auto determinant = [&](auto&& displacement) {
                const Vector2d here = displacement(Vector2d{x, y});
                Eigen::Matrix2d j = Eigen::Matrix2d::Identity();
                j.col(0) += (displacement(Vector2d{x + kStep, y}) - here) / kStep;
                j.col(1) += (displacement(Vector2d{x, y + kStep}) - here) / kStep;
                return j.determinant();
            };
            smallest = std::min(
                {smallest,
                 determinant([&](const Vector2d& p) { return field.TractorDisplacement(p); }),
                 determinant([&](const Vector2d& p) { return field.TrailerDisplacement(p); })});
        }
    }
    return smallest;
}

class EveryCanvasTest : public testing::TestWithParam<Projection> {
 protected:
    Projection canvas_ = GetParam();
    std::unique_ptr<StitchingMotionField> field_ =
        std::make_unique<StitchingMotionField>(canvas_, StitchingMotionFieldOptions{.fit = kFit});
};

TEST_P(EveryCanvasTest, AConstantDiscrepancyIsFoundInTheOverlapAndFadesOutsideIt) {
    const Vector2d e{6, -3};
    Converge(*field_, PairsIn(canvas_, 500, 760, [&](const Vector2d&) { return e; }));
    const auto at = [&](double x) {
        return Sample(field_->mesh(), field_->discrepancy(), {x, canvas_.height_px / 2.0});
    };
    EXPECT_LT((at(600) - e).norm(), 0.05) << at(600).transpose();
    EXPECT_LT((at(660) - e).norm(), 0.05) << at(660).transpose();
    EXPECT_LT(at(60).norm(), 0.05);
    EXPECT_LT(at(1220).norm(), 0.05);
    for (double x = 760; x < 1220; x += 40) EXPECT_LE(at(x + 40).norm(), at(x).norm() + 1e-3) << x;
}

TEST_P(EveryCanvasTest, KappaSplitsTheDiscrepancyBetweenTheUnitsAndLeavesNone) {
    const Vector2d e{5, 2};
    for (const double kappa : {0.0, 0.3, 0.5, 1.0}) {
        const auto field = std::make_unique<StitchingMotionField>(
            canvas_, StitchingMotionFieldOptions{.kappa = kappa});
        Converge(*field, PairsIn(canvas_, 500, 760, [&](const Vector2d&) { return e; }));
        const Vector2d at{640, canvas_.height_px / 2.0};
        const Vector2d tractor = field->TractorDisplacement(at);
        const Vector2d trailer = field->TrailerDisplacement(at);
        EXPECT_LT((tractor + kappa * e).norm(), 0.05) << kappa;
        EXPECT_LT((trailer - (1 - kappa) * e).norm(), 0.05) << kappa;
        EXPECT_LT((trailer - tractor - e).norm(), 0.05) << kappa;
    }
}

TEST_P(EveryCanvasTest, NothingFoldsEvenWithWildPairs) {
    cv::RNG random(3);
    for (int round = 0; round < 12; ++round) {
        CanvasPairs pairs;
        while (!pairs.full()) {
            const Vector2d at{random.uniform(0.0, 1279.0),
                              random.uniform(0.0, canvas_.height_px - 1.0)};
            const Vector2d wild{random.uniform(-1, 2) * 15.0, random.gaussian(20)};
            // Neighbouring columns pull against each other.
            const double sign = static_cast<int>(at.x() / 60) % 2 == 0 ? 20 : -20;
            pairs.push_back({at, at + wild + Vector2d{sign, -sign}});
        }
        field_->Update(pairs);
        field_->Extend();
        ASSERT_GT(SmallestJacobian(*field_, canvas_), 0) << round;
    }
    EXPECT_GT(field_->discrepancy().cwiseAbs().maxCoeff(), 1)
        << "a field that never moves tests nothing";
}

TEST_P(EveryCanvasTest, NothingFoldsWhereTheDiscrepancyJumps) {
    for (const double kappa : {0.0, 0.5, 1.0}) {
        for (const double jump : {23.0, -23.0}) {
            const auto field = std::make_unique<StitchingMotionField>(
                canvas_, StitchingMotionFieldOptions{.kappa = kappa});
            Converge(*field, PairsIn(canvas_, 400, 880, [&](const Vector2d& at) {
                return Vector2d{at.x() < 640 ? jump : -jump, 0};
            }));
            EXPECT_GT(SmallestJacobian(*field, canvas_), 0) << kappa << ' ' << jump;
            EXPECT_GT(field->discrepancy().cwiseAbs().maxCoeff(), 5);
        }
    }
}

TEST_P(EveryCanvasTest, TheFieldStaysWithinItsBoundWhateverThePairsSay) {
    const auto field = std::make_unique<StitchingMotionField>(
        canvas_, StitchingMotionFieldOptions{.fit = kFit, .most_px = 5});
    Converge(*field, PairsIn(canvas_, 500, 760, [](const Vector2d&) { return Vector2d(9, -14); }));
    const Vector2d at = Sample(field->mesh(), field->discrepancy(), {640, canvas_.height_px / 2.0});
    EXPECT_NEAR(at.x(), 5, 0.05);
    EXPECT_NEAR(at.y(), -5, 0.05);
    EXPECT_LE(field->discrepancy().cwiseAbs().maxCoeff(), 5);
}

TEST_P(EveryCanvasTest, NoPairsLeaveTheFieldAtRestAndResetForgets) {
    Converge(*field_, {}, 3);
    EXPECT_EQ(field_->discrepancy(), VertexField::Zero());
    Converge(*field_,
             PairsIn(canvas_, 500, 760,
                     [](const Vector2d&) {
                         return Vector2d{4, 4};
                     }),
             3);
    EXPECT_NE(field_->discrepancy(), VertexField::Zero());
    field_->Reset();
    EXPECT_EQ(field_->discrepancy(), VertexField::Zero());
    field_->Extend();
    EXPECT_EQ(field_->discrepancy(), VertexField::Zero());
}

TEST_P(EveryCanvasTest, WithoutFurtherMatchesTheFieldFadesAway) {
    Converge(*field_, PairsIn(canvas_, 500, 760, [](const Vector2d&) { return Vector2d{6, 0}; }));
    double last = field_->discrepancy().norm();
    for (int i = 0; i < 80; ++i) {
        field_->Extend();
        EXPECT_LE(field_->discrepancy().norm(), last + 1e-3) << i;
        last = field_->discrepancy().norm();
    }
    EXPECT_LT(field_->discrepancy().cwiseAbs().maxCoeff(), 0.1F);
}

TEST_P(EveryCanvasTest, AThirdOfWrongPairsHardlyMovesTheField) {
    const Vector2d e{5, -2};
    cv::RNG random(6);
    CanvasPairs pairs = PairsIn(canvas_, 500, 760, [&](const Vector2d&) { return e; });
    for (CanvasPair& pair : pairs) {
        if (random.uniform(0.0, 1.0) < 0.3)
            pair.trailer_px += Vector2d{random.gaussian(40), random.gaussian(40)};
    }
    Converge(*field_, pairs);
    const Vector2d at{640, canvas_.height_px / 2.0};
    EXPECT_LT((Sample(field_->mesh(), field_->discrepancy(), at) - e).norm(), 0.5);
}

INSTANTIATE_TEST_SUITE_P(Canvases, EveryCanvasTest, testing::Values(kPlane, kRing),
                         [](const auto& test) { return test.param.IsRing() ? "Ring" : "Plane"; });

TEST(StitchingMotionFieldTest, ADiscrepancyThatVariesOverTheOverlapIsFollowed) {
    const auto field =
        std::make_unique<StitchingMotionField>(kPlane, StitchingMotionFieldOptions{.kappa = 0});
    const auto e = [](const Vector2d& p) {
        return Vector2d{0.02 * (p.x() - 640), 0.015 * (p.y() - 200)};
    };
    Converge(*field, PairsIn(kPlane, 440, 840, e));
    for (double x = 540; x <= 740; x += 25) {
        for (double y = 60; y <= 340; y += 40) {
            EXPECT_LT((field->TrailerDisplacement({x, y}) - e({x, y})).norm(), 0.15)
                << x << ' ' << y;
        }
    }
}

TEST(StitchingMotionFieldTest, OnARingTheOverlapMayLieAcrossTheEdge) {
    const auto field =
        std::make_unique<StitchingMotionField>(kRing, StitchingMotionFieldOptions{.fit = kFit});
    const Vector2d e{6, -3};
    Converge(*field, PairsIn(kRing, 1280 - 130, 1280 + 130, [&](const Vector2d&) { return e; }));
    for (const double x : {-0.4, 0.0, 30.0, 1250.0, 1279.4}) {
        EXPECT_LT((Sample(field->mesh(), field->discrepancy(), {x, 120}) - e).norm(), 0.1) << x;
    }
    EXPECT_LT(Sample(field->mesh(), field->discrepancy(), {640, 120}).norm(), 0.05);
}

TEST(StitchingMotionFieldTest, WhereOnARingTheOverlapLiesDoesNotMatter) {
    const auto field_at = [](double x0) {
        const auto field =
            std::make_unique<StitchingMotionField>(kRing, StitchingMotionFieldOptions{.fit = kFit});
        Converge(*field, PairsIn(kRing, x0, x0 + 200, [](const Vector2d& at) {
            return Vector2d{5 + 0.01 * at.y(), 2};
        }));
        return field->discrepancy();
    };
    const VertexField middle = field_at(640.5);
    const VertexField near_edge = field_at(640.5 - 14 * 40);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kCols; ++col) {
            const int moved = (col + 14) % Mesh::kCols;
            const Eigen::Vector2f a = near_edge.col(Mesh::Index(row, col));
            const Eigen::Vector2f b = middle.col(Mesh::Index(row, moved));
            EXPECT_LT((a - b).norm(), 0.05F) << row << ' ' << col;
        }
    }
}

TEST(StitchingMotionFieldTest, CarriedAlongItIsTheSameFieldOfTheMovedScene) {
    const auto field =
        std::make_unique<StitchingMotionField>(kPlane, StitchingMotionFieldOptions{});
    Converge(*field, PairsIn(kPlane, 400, 880, [](const Vector2d& p) {
        return Vector2d{0.02 * (p.x() - 640), 3};
    }));
    const VertexField early = field->discrepancy();
    Eigen::Matrix3d M_early_late = Eigen::Matrix3d::Identity();
    M_early_late(0, 2) = -33;  // the scene has moved 33 px to the right
    field->Carry(M_early_late);
    for (double x = 480; x < 840; x += 20) {
        const Vector2d now = Sample(field->mesh(), field->discrepancy(), {x, 200});
        const Vector2d before = Sample(field->mesh(), early, {x - 33, 200});
        EXPECT_LT((now - before).norm(), 0.1) << x;
    }
}

TEST(StitchingMotionFieldTest, SteepEdgesAreEasedWhereTheyAreAndTheRestStays) {
    const auto field =
        std::make_unique<StitchingMotionField>(kPlane, StitchingMotionFieldOptions{});
    Converge(*field, PairsIn(kPlane, 300, 980, [](const Vector2d& p) {
        return Vector2d{p.x() < 640 ? -20.0 : 20.0, 0};
    }));
    EXPECT_NEAR(Sample(field->mesh(), field->discrepancy(), {400, 200}).x(), -20, 0.5);
    EXPECT_NEAR(Sample(field->mesh(), field->discrepancy(), {880, 200}).x(), 20, 0.5);
    EXPECT_GT(SmallestJacobian(*field, kPlane), 0);
}

}  // namespace
}  // namespace hitchview::algo
