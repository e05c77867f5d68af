#include <gtest/gtest.h>

#include "algo/field_extension.hpp"

namespace hitchview::algo {
namespace {

const Projection kPlane = Projection::Plane(640, 360);
const Projection kRing = Projection::Cylinder(1024, 180, 0.5);

/// A field that is known to be (3, -1) in some columns, all rows.
struct KnownColumns {
    KnownColumns(int from_col, int to_col) {
        for (int row = 0; row < Mesh::kVertexRows; ++row) {
            for (int col = from_col; col <= to_col; ++col) {
                measured.col(Mesh::Index(row, col)) = Eigen::Vector2f(3, -1);
                confidence(Mesh::Index(row, col)) = 1;
            }
        }
    }
    VertexField measured = VertexField::Constant(99);  // elsewhere: not to be looked at
    VertexScalars confidence = VertexScalars::Zero();
};

TEST(FieldExtensionTest, NothingMeasuredIsNoField) {
    const VertexField field =
        ExtendField(Mesh(kPlane), VertexField::Constant(7), VertexScalars::Zero());
    EXPECT_LT(field.cwiseAbs().maxCoeff(), 1e-6F);
}

TEST(FieldExtensionTest, WhereItIsKnownTheFieldIsFollowed) {
    const KnownColumns known(12, 20);
    const VertexField field = ExtendField(Mesh(kPlane), known.measured, known.confidence);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        EXPECT_NEAR(field(0, Mesh::Index(row, 16)), 3, 0.03F);
        EXPECT_NEAR(field(1, Mesh::Index(row, 16)), -1, 0.03F);
    }
}

TEST(FieldExtensionTest, OutsideItFadesSteadilyToZero) {
    const KnownColumns known(12, 20);
    const VertexField field = ExtendField(Mesh(kPlane), known.measured, known.confidence);
    for (int col = 21; col <= Mesh::kCols; ++col) {
        const float here = field(0, Mesh::Index(5, col));
        EXPECT_GE(here, 0);
        EXPECT_LT(here, field(0, Mesh::Index(5, col - 1)));
    }
    EXPECT_LT(field(0, Mesh::Index(5, 28)), 0.1F);
    EXPECT_LT(field(0, Mesh::Index(5, 4)), 0.1F);
}

TEST(FieldExtensionTest, OnARingTheEdgesAreNeighbours) {
    const KnownColumns known(28, 30);
    const VertexField field = ExtendField(Mesh(kRing), known.measured, known.confidence);
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        EXPECT_EQ(field.col(Mesh::Index(row, 0)), field.col(Mesh::Index(row, Mesh::kCols)));
        // Columns 27 and 31, 24 and 34 = 2 are as far from the known ones.
        EXPECT_NEAR(field(0, Mesh::Index(row, 31)), field(0, Mesh::Index(row, 27)), 1e-4F);
        EXPECT_NEAR(field(0, Mesh::Index(row, 2)), field(0, Mesh::Index(row, 24)), 1e-4F);
        EXPECT_GT(field(0, Mesh::Index(row, 2)), 0.01F);
    }
}

TEST(FieldExtensionTest, AnOutlierWithoutSupportDoesNotCount) {
    KnownColumns known(12, 20);
    const VertexField clean = ExtendField(Mesh(kPlane), known.measured, known.confidence);
    known.measured.col(Mesh::Index(3, 25)).setConstant(-500);
    const VertexField field = ExtendField(Mesh(kPlane), known.measured, known.confidence);
    EXPECT_EQ(field, clean);
}

}  // namespace
}  // namespace hitchview::algo
