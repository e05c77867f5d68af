#include <gtest/gtest.h>

#include <numbers>

#include "algo/composed_map.hpp"
#include "tests/support/small_ring.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

/// A ring of three cameras per unit; poses, offset, discrepancy and detail all other than nothing.
class RingCompositionTest : public testing::Test {
 protected:
    RingCompositionTest() {
        rig_[Unit::kTractor] = UnitGeometry::Ring(canvas_, tests::LevelCameras(3, 1.2, 0), {});
        rig_[Unit::kTrailer] =
            UnitGeometry::Ring(canvas_, tests::LevelCameras(3, 1.2, std::numbers::pi), {});
        composition_.M_canvas_view = {
            {ToPose(canvas_, {{3, 0.01, -0.02}}), ToPose(canvas_, {{-5, -0.015, 0.01}})}};
        composition_.kappa = 0.3;
        for (int vertex = 0; vertex < Mesh::kVertices; ++vertex) {
            const auto phase = static_cast<float>(vertex % Mesh::kVertexCols % Mesh::kCols) * 0.4F;
            composition_.discrepancy.col(vertex) << 4 * std::sin(phase), 1;
            composition_.view_offset[Unit::kTractor].col(vertex) << 2, std::cos(phase);
        }
        composition_.detail = CornerField(canvas_, {5, -1});
    }

    /// Farthest that a corner is shown from its place, as found from what a camera shows there.
    [[nodiscard]] double FarthestOff(const ComposedMap& map, const Composition& composition) const {
        double farthest_px = 0;
        for (int source = 0; source < map.cameras(); ++source) {
            const UnitGeometry& geometry = *rig_[map.unit_of(source)];
            for (int row = 2; row < map.block_rows() - 1; ++row) {
                for (int col = 1; col < map.block_cols(); ++col) {
                    const ComposedMap::Corner& corner = map.corner(source, row, col);
                    if (!corner.sees || corner.weight <= 0) continue;
                    const auto ray =
                        geometry.ViewRay(map.camera_of(source), Vector2d(corner.x, corner.y));
                    const Vector2d shown =
                        ToCanvas(canvas_, geometry.view(), composition, map.unit_of(source), *ray);
                    const Vector2d corner_px = 8 * Vector2d(col, row) - Vector2d(0.5, 0.5);
                    const double off_px = canvas_.Difference(shown, corner_px).norm();
                    farthest_px = std::max(farthest_px, off_px);
                }
            }
        }
        return farthest_px;
    }

    const Projection canvas_ = Projection::Cylinder(768, 128, 0.5);
    PerUnit<std::optional<UnitGeometry>> rig_;
    Composition composition_;
    SerialRunner runner_;
};

TEST_F(RingCompositionTest, TheWholeDiscrepancyIsThatOfTheMeshWithTheDetail) {
    const Mesh mesh(canvas_);
    for (const Vector2d& at : {Vector2d(100, 40), Vector2d(517.3, 99.1)}) {
        const Vector2d of_mesh = Sample(mesh, composition_.discrepancy, at);
        const Vector2d whole = WholeDiscrepancy(mesh, composition_, at);
        EXPECT_LT((whole - of_mesh - Vector2d(5, -1)).norm(), 1e-5);
    }
    composition_.detail = CornerField();
    const Vector2d at(200, 60);
    EXPECT_EQ(WholeDiscrepancy(mesh, composition_, at), Sample(mesh, composition_.discrepancy, at));
}

TEST_F(RingCompositionTest, ToCanvasInvertsWhatTheMapShowsOfTheDetail) {
    ComposedMap map(canvas_, rig_, {});
    map.Build(composition_, runner_);
    Composition shown = composition_;
    shown.detail = map.shown_detail();
    EXPECT_LT(FarthestOff(map, shown), 0.1);
    EXPECT_GT(FarthestOff(map, composition_), 1) << "far from the seams the detail is not shown";
}

TEST_F(RingCompositionTest, ToCanvasInvertsAMapWithoutDetail) {
    composition_.detail = CornerField();
    ComposedMap map(canvas_, rig_, {});
    map.Build(composition_, runner_);
    EXPECT_LT(FarthestOff(map, composition_), 0.1);
}

TEST_F(RingCompositionTest, AllOfTheDetailIsShownAtTheSeamsAndNoneFarAway) {
    composition_.discrepancy.setZero();
    composition_.detail.Fill({5, -0.4F});
    ComposedMap map(canvas_, rig_, {});
    map.Build(composition_, runner_);
    const CornerField& shown = map.shown_detail();
    ASSERT_EQ(shown.cols(), composition_.detail.cols());
    for (int row = 0; row < shown.rows(); ++row) {
        for (const Overlap overlap : kOverlaps) {
            const Vector2d seam(map.seam_px(overlap, row), shown.Pixel(row, 0).y());
            EXPECT_LT((shown.Sample(seam) - Vector2f(5, -0.4F)).norm(), 1e-3) << row;
            const int half = overlap == Overlap::kLeft ? 0 : shown.cols() / 2;
            for (int col = half; col < half + shown.cols() / 2; ++col) {
                if (std::abs(shown.Pixel(row, col).x() - seam.x()) < 80) continue;
                EXPECT_LT(shown.at(row, col).norm(), 1e-3) << row << " " << col;
            }
        }
    }
}

TEST_F(RingCompositionTest, AMapWithoutDetailShowsNoneEvenAfterOneThatHadSome) {
    ComposedMap map(canvas_, rig_, {});
    EXPECT_TRUE(map.shown_detail().empty());
    map.Build(composition_, runner_);
    EXPECT_FALSE(map.shown_detail().empty());
    composition_.detail = CornerField();
    map.Build(composition_, runner_);
    EXPECT_TRUE(map.shown_detail().empty());
    EXPECT_LT(FarthestOff(map, composition_), 0.1);
}

}  // namespace
}  // namespace hitchview::algo
