#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "algo/mesh.hpp"
#include "algo/seam_detail.hpp"
#include "algo/task_runner.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// A ring with its seams in columns 30 (left) and 96 (right) of 129.
class SeamDetailTest : public testing::Test {
 protected:
    SeamDetailTest() {
        UnitSeams::Coverage covered;
        for (const Unit unit : kUnits) {
            covered[unit].assign(static_cast<std::size_t>(detail_.rows() * detail_.cols()), 0);
            for (int row = 0; row < detail_.rows(); ++row) {
                for (const int seam : {kLeft, kRight}) {
                    for (int col = seam - 10; col <= seam + 10; ++col)
                        covered[unit][static_cast<std::size_t>(row * detail_.cols() + col)] = 1;
                }
            }
        }
        seams_.FindOverlaps(covered);
        seams_.Follow({});
    }
    void Fade(const SeamDetailOptions& options = {}) {
        SerialRunner runner;
        CornerField coarse(canvas_, Vector2f::Zero());
        for (int row = 0; row < coarse.rows(); ++row) {
            for (int col = 0; col < coarse.cols(); ++col) coarse.at(row, col) = Coarse(row, col);
        }
        FadeFromSeams(coarse, detail_, seams_, options, runner, shown_);
    }
    void FillDetail(std::uint64_t seed, float most_px) {
        cv::RNG random(seed);
        for (int row = 0; row < detail_.rows(); ++row) {
            for (int col = 0; col < detail_.cols(); ++col) {
                detail_.at(row, col) = {random.uniform(-most_px, most_px),
                                        random.uniform(-most_px, most_px)};
            }
        }
    }
    void FillMesh(std::uint64_t seed, float most_px) {
        cv::RNG random(seed);
        for (float& value : mesh_.reshaped()) value = random.uniform(-most_px, most_px);
        CloseRing(Mesh(canvas_), mesh_);
    }
    [[nodiscard]] Vector2f Whole(int row, int col) const {
        return shown_.at(row, col) + Coarse(row, col);
    }
    [[nodiscard]] Vector2f Coarse(int row, int col) const {
        return Sample(Mesh(canvas_), mesh_, detail_.Pixel(row, col)).cast<float>();
    }
    /// Visits neighbours in a row on the same side of the ring's middle.
    template <typename Visitor>
    void ForEachStep(const Visitor& visit) const {
        for (int row = 0; row < shown_.rows(); ++row) {
            for (int col = 1; col < shown_.cols(); ++col) {
                if (col != shown_.cols() / 2)
                    visit(Vector2f(Whole(row, col) - Whole(row, col - 1)));
            }
        }
    }

    static constexpr int kLeft = 30;
    static constexpr int kRight = 96;
    const Projection canvas_ = Projection::Cylinder(1024, 176, 0.5);
    CornerField detail_{canvas_, Vector2f::Zero()};
    CornerField shown_{canvas_, Vector2f(99, 99)};
    UnitSeams seams_{canvas_, detail_.rows(), detail_.cols(), 8, {}};
    VertexField mesh_ = VertexField::Zero();
};

TEST_F(SeamDetailTest, NoRowChangesFasterThanTheLimitHoweverTornDetailAndMesh) {
    for (const double kappa : {0.0, 0.3, 0.5, 1.0}) {
        const SeamDetailOptions options{.kappa = kappa};
        FillDetail(5, 60);
        FillMesh(6, 20);
        Fade(options);
        const double moves = std::max(kappa, 1 - kappa);  // of the unit that moves most
        double most_x = 0;
        ForEachStep([&](const Vector2f& step) {
            most_x = std::max(most_x, double{std::abs(step.x())} * moves / 8);
            EXPECT_LE(std::abs(step.x()) * moves, options.stretch * 8 + 1e-3) << kappa;
            EXPECT_LE(std::abs(step.y()) * moves, options.tilt * 8 + 1e-3) << kappa;
        });
        EXPECT_GT(most_x, 0.99 * options.stretch) << "the limit was reached";
    }
}

// Together with the limits along the rows: a Jacobian determinant of .02 or more.
TEST_F(SeamDetailTest, NoCellFoldsHoweverTornDetailAndMesh) {
    for (const double kappa : {0.0, 0.3, 0.5, 1.0}) {
        FillDetail(15, 120);
        FillMesh(16, 20);
        Fade({.kappa = kappa});
        for (const double moves : {-kappa, 1 - kappa}) {
            double least = 1;
            for (int row = 1; row < shown_.rows(); ++row) {
                for (int col = 1; col < shown_.cols(); ++col) {
                    if (col == shown_.cols() / 2) continue;
                    for (const int at_row : {row - 1, row}) {
                        for (const int at_col : {col - 1, col}) {
                            const Vector2f right =
                                (Whole(at_row, col) - Whole(at_row, col - 1)) * moves / 8;
                            const Vector2f down =
                                (Whole(row, at_col) - Whole(row - 1, at_col)) * moves / 8;
                            const double determinant =
                                (1 + right.x()) * (1 + down.y()) - right.y() * down.x();
                            least = std::min(least, determinant);
                        }
                    }
                }
            }
            EXPECT_GT(least, 0.015) << kappa;
            const bool moves_most = std::abs(moves) >= std::max(kappa, 1 - kappa);
            EXPECT_TRUE(!moves_most || least < 0.2) << least << ": the limits were reached";
        }
    }
}

TEST_F(SeamDetailTest, AtTheSeamItIsTheDetailHoweverTornAlongTheRows) {
    FillDetail(7, 60);
    FillMesh(8, 20);
    for (int row = 1; row < detail_.rows(); ++row) {  // the whole is the same in every row
        for (int col = 0; col < detail_.cols(); ++col)
            detail_.at(row, col) = detail_.at(0, col) + Coarse(0, col) - Coarse(row, col);
    }
    Fade();
    for (int row = 0; row < detail_.rows(); ++row) {
        EXPECT_LT((shown_.at(row, kLeft) - detail_.at(row, kLeft)).norm(), 1e-3) << row;
        EXPECT_LT((shown_.at(row, kRight) - detail_.at(row, kRight)).norm(), 1e-3) << row;
    }
}

TEST_F(SeamDetailTest, WhatBendsLittleCountsFullyRoundTheSeamAndNotAtAllFarAway) {
    detail_.Fill({10, 0.5F});
    Fade();
    const SeamDetailOptions options;
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = 0; col < detail_.cols(); ++col) {
            const int seam = col < detail_.cols() / 2 ? kLeft : kRight;
            const double away_px = 8.0 * std::abs(col - seam);
            const Vector2f& shown = shown_.at(row, col);
            if (away_px <= options.core_px)
                EXPECT_LT((shown - Vector2f(10, 0.5F)).norm(), 1e-3) << col;
            else if (away_px >= options.core_px + options.fade_px)
                EXPECT_LT(shown.norm(), 1e-3) << col;
            else
                EXPECT_TRUE(shown.x() > 0 && shown.x() < 10) << col;
        }
    }
}

TEST_F(SeamDetailTest, AStepBesideTheSeamIsReachedAlongARampOfTheLimit) {
    const SeamDetailOptions options{.core_px = 1e4};
    for (int row = 0; row < detail_.rows(); ++row) {
        for (int col = kLeft + 2; col < detail_.cols() / 2; ++col) detail_.at(row, col).x() = 50;
    }
    Fade(options);
    const double step_px = options.stretch * 8 / 0.5;
    for (int col = kLeft; col < kLeft + 12; ++col) {
        const double ramp = std::clamp((col - kLeft - 1) * step_px, 0.0, 50.0);
        EXPECT_NEAR(shown_.at(9, col).x(), ramp, 1e-3) << col;
    }
}

}  // namespace
}  // namespace hitchview::algo
