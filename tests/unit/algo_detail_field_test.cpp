#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "algo/detail_field.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// What the units' pictures differ by at a canvas pixel.
using Truth = std::function<Vector2d(const Vector2d&)>;

class DetailFieldTest : public testing::Test {
 protected:
    /// Pairs every 4 px of a rectangle, which meet where `truth` is asked.
    void Show(const Vector2d& first, const Vector2d& end, const Truth& truth) {
        for (double y = first.y() + 1; y < end.y(); y += 4) {
            for (double x = first.x() + 1; x < end.x(); x += 4) Add({x, y}, truth({x, y}), 1);
        }
    }
    void Add(const Vector2d& at, const Vector2d& e, float weight) {
        const Overlap overlap = at.x() < canvas_.Centre().x() ? Overlap::kLeft : Overlap::kRight;
        field_.Add(overlap, {at - kKappa * e, at + (1 - kKappa) * e}, weight);
    }
    void Fit() {
        for (const Overlap overlap : kOverlaps) field_.Fit(overlap, mesh_);
    }
    template <typename Samples>
    void FitAnew(const Samples& show) {
        for (const Overlap overlap : kOverlaps) field_.Clear(overlap);
        show();
        Fit();
    }
    void FitAnew() {
        FitAnew([] {});
    }
    void ExpectNothing() const {
        for (int row = 0; row < field_.detail().rows(); ++row) {
            for (int col = 0; col < field_.detail().cols(); ++col) {
                EXPECT_LT(field_.detail().at(row, col).norm(), 0.5F) << row << " " << col;
                EXPECT_EQ(Doubt(row, col), DetailFieldOptions{}.unknown_px);
            }
        }
    }
    /// With the mesh's part.
    [[nodiscard]] Vector2d At(int row, int col) const {
        return field_.detail().at(row, col).cast<double>() +
               Sample(Mesh(canvas_), mesh_, field_.detail().Pixel(row, col));
    }
    [[nodiscard]] float Doubt(int row, int col) const { return field_.doubt_px().at(row, col); }

    static constexpr double kKappa = 0.3;
    const Projection canvas_ = Projection::Cylinder(1024, 176, 0.5);
    DetailField field_{canvas_, {.kappa = kKappa}};
    VertexField mesh_ = VertexField::Zero();
};

/// 128 px of something 48 px nearer than what is behind it; `sign` -1: on the vehicle's right.
Truth Wall(double from_px, double sign) {
    return [=](const Vector2d& p) {
        const bool near = p.x() >= from_px && p.x() < from_px + 128;
        return Vector2d(near ? sign * 48 : 0, near ? -2 : 0);
    };
}

Truth Flat(double e_px) {
    return [=](const Vector2d&) { return Vector2d(e_px, 0); };
}

/// Neighbours differ by 30 px.
Truth Torn(double e_px) {
    return
        [e_px, i = 0](const Vector2d&) mutable { return Vector2d(e_px + 30 * (i++ % 3) - 30, 0); };
}

TEST_F(DetailFieldTest, FollowsAWideNearThingInEitherOverlap) {
    Show({160, 0}, {440, 176}, Wall(240, 1));
    Show({600, 0}, {880, 176}, Wall(680, -1));
    Fit();
    for (int row = 2; row < 20; ++row) {
        for (int col = 36; col < 41; ++col) {
            EXPECT_LT((At(row, col) - Vector2d(48, -2)).norm(), 0.5) << row << " " << col;
            EXPECT_LT((At(row, col + 55) - Vector2d(-48, -2)).norm(), 0.5) << row << " " << col;
        }
        for (int col = 22; col < 26; ++col)
            EXPECT_LT(At(row, col).norm(), 0.5) << row << " " << col;
    }
}

TEST_F(DetailFieldTest, WhatTheMeshSaysAlreadyIsNoDetail) {
    const Mesh mesh(canvas_);
    const auto smooth = [](const Vector2d& p) {
        return Vector2d(6 + 0.02 * p.x(), 3 - 0.03 * p.y());
    };
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col)
            mesh_.col(Mesh::Index(row, col)) = smooth(mesh.Vertex(row, col)).cast<float>();
    }
    Show({160, 0}, {440, 176}, [&](const Vector2d& p) { return Sample(mesh, mesh_, p); });
    Fit();
    for (int row = 2; row < 20; ++row) {
        for (int col = 22; col < 54; ++col)
            EXPECT_LT(field_.detail().at(row, col).norm(), 0.5F) << row << " " << col;
    }
}

TEST_F(DetailFieldTest, IgnoresAThinNearThingThatWouldFoldAndDoubtsItsPlace) {
    const auto pole = [](const Vector2d& p) {
        return Vector2d(p.x() >= 296 && p.x() < 304 ? 48 : 0, 0);
    };
    Show({160, 0}, {440, 176}, pole);
    Fit();
    for (int row = 2; row < 20; ++row) {
        for (int col = 22; col < 54; ++col)
            EXPECT_LT(At(row, col).norm(), 0.5) << row << " " << col;
        EXPECT_GT(Doubt(row, 37), 4) << row;
        EXPECT_LT(Doubt(row, 30), 0.5) << row;
        EXPECT_LT(Doubt(row, 45), 0.5) << row;
    }
}

TEST_F(DetailFieldTest, DoubtIsLargeWhereSamplesDisagreeAndUnknownWhereThereAreNone) {
    int i = 0;
    const auto torn = [&](const Vector2d& p) {
        const bool disagree = p.x() >= 280 && p.x() < 340;
        return Vector2d(disagree ? 30 * (i++ % 3) - 30 : 0, 0);
    };
    Show({160, 0}, {440, 176}, torn);
    Fit();
    const DetailFieldOptions options;
    for (int row = 2; row < 20; ++row) {
        for (int col = 37; col < 41; ++col) {
            EXPECT_GT(Doubt(row, col), 8) << row << " " << col;
            EXPECT_LE(Doubt(row, col), options.most_doubt_px) << row << " " << col;
        }
        EXPECT_LT(Doubt(row, 25), 0.5) << row;
        for (const int col : {0, 10, 64, 100, 128}) {
            EXPECT_EQ(Doubt(row, col), options.unknown_px) << row << " " << col;
            EXPECT_EQ(field_.detail().at(row, col), Vector2f::Zero()) << row << " " << col;
        }
    }
}

TEST_F(DetailFieldTest, AHoleTakesWhatLiesAroundItButStaysInDoubt) {
    const auto flat = [](const Vector2d&) { return Vector2d(9, 1); };
    Show({160, 0}, {280, 176}, flat);
    Show({328, 0}, {440, 176}, flat);
    Show({280, 0}, {328, 64}, flat);
    Show({280, 112}, {328, 176}, flat);
    Fit();
    EXPECT_NEAR(At(11, 38).x(), 9, 1.5);
    EXPECT_EQ(Doubt(11, 38), DetailFieldOptions{}.unknown_px);
    EXPECT_LT(Doubt(11, 28), 0.5);
}

TEST_F(DetailFieldTest, ASampleThatTellsLittleCountsLess) {
    const Vector2d place(300, 88);
    const auto flat = [](const Vector2d&) { return Vector2d(0, 0); };
    Show({160, 0}, {440, 176}, flat);
    for (int i = 0; i < 6; ++i) Add(place + Vector2d(0.1 * i, 0), {6, 0}, 0.02F);
    Fit();
    EXPECT_LT(At(11, 38).norm(), 0.3);
}

TEST_F(DetailFieldTest, WhatIsLostFadesByAndBy) {
    Show({160, 0}, {440, 176}, Wall(240, 1));
    Fit();
    double last = At(10, 38).x();
    ASSERT_NEAR(last, 48, 0.5);
    for (int fit = 0; fit < 60; ++fit) {
        FitAnew();
        EXPECT_LE(last - At(10, 38).x(), DetailPastOptions{}.most_step_px + 1e-4) << fit;
        last = At(10, 38).x();
    }
    ExpectNothing();
}

TEST_F(DetailFieldTest, WhereSamplesAgreeItFollowsThemAtOnce) {
    Show({160, 0}, {440, 176}, Wall(240, 1));
    Fit();
    FitAnew([&] { Show({160, 0}, {440, 176}, Flat(5)); });
    for (int row = 2; row < 20; ++row) {
        for (int col = 22; col < 54; ++col)
            EXPECT_LT((At(row, col) - Vector2d(5, 0)).norm(), 0.5) << row << " " << col;
    }
}

TEST_F(DetailFieldTest, WhereSamplesDisagreeNothingLeaps) {
    Show({160, 0}, {440, 176}, Flat(0));
    Fit();
    for (int fit = 1; fit < 5; ++fit) {
        FitAnew([&] { Show({160, 0}, {440, 176}, Torn(30)); });
        for (int row = 2; row < 20; ++row) {
            for (int col = 22; col < 54; ++col) {
                ASSERT_GT(Doubt(row, col), DetailPastOptions{}.unsure_px);
                EXPECT_LE(At(row, col).cwiseAbs().maxCoeff(),
                          fit * DetailPastOptions{}.most_step_px + 1e-4);
            }
        }
    }
}

TEST_F(DetailFieldTest, WhatIsInDoubtGoesAlongWithWhatIsSureInItsRow) {
    const auto show = [&](double e_px) {
        Show({160, 0}, {280, 176}, Flat(e_px));
        Show({280, 0}, {340, 176}, Torn(e_px));
        Show({340, 0}, {440, 176}, Flat(e_px));
    };
    show(0);
    Fit();
    const double before = At(10, 39).x();
    FitAnew([&] { show(20); });
    ASSERT_GT(Doubt(10, 39), DetailPastOptions{}.unsure_px);
    EXPECT_NEAR(At(10, 39).x() - before, 20, 2 + DetailPastOptions{}.most_step_px);
}

TEST_F(DetailFieldTest, AfterAResetNothingIsLeftAndNothingHeld) {
    Show({160, 0}, {440, 176}, Wall(240, 1));
    Fit();
    ASSERT_GT(At(10, 38).norm(), 20);
    field_.Reset();
    Fit();
    ExpectNothing();
    FitAnew([&] { Show({160, 0}, {440, 176}, Wall(240, 1)); });
    EXPECT_NEAR(At(10, 38).x(), 48, 0.5);
}

TEST_F(DetailFieldTest, PairsBesideTheCanvasAndTooManyOnOnePlaceAreLeftOut) {
    Add({300, -40}, {5, 5}, 1);
    Add({300, 400}, {5, 5}, 1);
    Show({200, 40}, {400, 140}, [](const Vector2d&) { return Vector2d(3, 0); });
    for (int i = 0; i < 100; ++i) Add({300, 88}, {33, 0}, 1);
    Fit();
    EXPECT_NEAR(At(8, 30).x(), 3, 0.2);
    EXPECT_LT(Doubt(8, 30), 0.5);
}

}  // namespace
}  // namespace hitchview::algo
