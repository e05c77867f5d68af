#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "app/truth_field.hpp"
#include "app/truth_path.hpp"
#include "app/truth_seam.hpp"
#include "app/truth_spectrum.hpp"
#include "app/truth_warp.hpp"
#include "tests/support/simulated_pictures.hpp"

namespace hitchview::app {
namespace {

using Eigen::Vector2d;

constexpr double kRate_hz = 30;

/// Two slow motions far below the band beside one sine inside it or wherever it is asked for.
std::vector<double> Path(double sine_px, double sine_hz) {
    std::vector<double> path;
    for (int i = 0; i < 240; ++i) {
        const double t = i / kRate_hz;
        path.push_back(40 * t - 3 * t * t + 25 * std::sin(2 * std::numbers::pi * 0.1 * t) +
                       sine_px * std::sin(2 * std::numbers::pi * sine_hz * t + 0.7));
    }
    return path;
}

TEST(TruthSpectrumTest, ASineInTheBandGivesHalfItsSquareWhateverTheSlowMotion) {
    EXPECT_NEAR(BandPower(Path(2, 5), kRate_hz, {1, 15}), 2.0, 0.02);
    EXPECT_NEAR(BandPower(Path(0.3, 11.3), kRate_hz, {1, 15}), 0.045, 0.002);
}

TEST(TruthSpectrumTest, ASineOutsideTheBandGivesNothing) {
    EXPECT_LT(BandPower(Path(2, 5), kRate_hz, {7, 15}), 0.002);
    EXPECT_LT(BandPower(Path(0, 0), kRate_hz, {1, 15}), 0.002);
}

/// A smooth field that a mesh can hold exactly: its vertices' values are known.
algo::VertexField KnownField() {
    algo::VertexField field;
    for (int row = 0; row < algo::Mesh::kVertexRows; ++row) {
        for (int col = 0; col < algo::Mesh::kVertexCols; ++col) {
            const double around =
                2 * std::numbers::pi * (col % algo::Mesh::kCols) / algo::Mesh::kCols;
            field.col(algo::Mesh::Index(row, col)) =
                Eigen::Vector2d(8 * std::sin(around) + 0.5 * row, 3 * std::cos(around) - 0.2 * row)
                    .cast<float>();
        }
    }
    return field;
}

std::vector<FieldSample> SamplesOf(const algo::Mesh& mesh, const algo::VertexField& field,
                                   double from_x, double to_x) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> x(from_x, to_x);
    std::uniform_real_distribution<double> y(0, 359);
    std::vector<FieldSample> samples;
    for (int i = 0; i < 6000; ++i) {
        const double y_px = y(random);
        const double x_px = x(random);
        const Vector2d pixel(x_px, y_px);
        samples.push_back({pixel, algo::Sample(mesh, field, pixel)});
    }
    return samples;
}

TEST(TruthFieldTest, RecoversAFieldOfTheMeshFromSamplesAllRoundTheRing) {
    const algo::Mesh mesh(algo::Projection::Cylinder(2048, 360, 0.5));
    const auto samples = SamplesOf(mesh, KnownField(), -0.5, 2047.5);
    const algo::VertexField found = FitField(mesh, samples, 1e-6);
    EXPECT_LT((found - KnownField()).cwiseAbs().maxCoeff(), 1e-2F);
    EXPECT_EQ(found.col(0), found.col(algo::Mesh::kCols));
}

TEST(TruthFieldTest, FollowsTheSamplesWhereTheyAreAndStaysCalmElsewhere) {
    const algo::Mesh mesh(algo::Projection::Cylinder(2048, 360, 0.5));
    const auto samples = SamplesOf(mesh, KnownField(), 400, 700);
    const algo::VertexField found = FitField(mesh, samples, 0.05);
    double worst = 0;
    for (const FieldSample& sample : samples)
        worst =
            std::max(worst, (algo::Sample(mesh, found, sample.pixel) - sample.motion_px).norm());
    EXPECT_LT(worst, 0.5);
    EXPECT_LT(found.cwiseAbs().maxCoeff(), 20);
}

/// All corners known, moved by A p + b.
WarpGrid Affine(const Eigen::Matrix2d& A, const Vector2d& b) {
    WarpGrid warp(12, 20, 16);
    for (int row = 0; row < warp.rows; ++row) {
        for (int col = 0; col < warp.cols; ++col) {
            const Vector2d from(col * warp.spacing_px, row * warp.spacing_px);
            warp.motion_px[warp.At(row, col)] = A * from + b - from;
            warp.known[warp.At(row, col)] = 1;
        }
    }
    return warp;
}

Eigen::Matrix2d Turn(double angle_rad) {
    return Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
}

TEST(TruthWarpTest, ASimilarityIsNoDistortionAndNoFold) {
    const WarpGrid warp = Affine(1.3 * Turn(0.4), {30, -7});
    EXPECT_EQ(FoldedCells(warp), 0);
    EXPECT_NEAR(LeastCellRatio(warp, WarpGrid(12, 20, 16)), 1, 1e-9);
    EXPECT_NEAR(AffineRatio(warp), 1, 1e-9);
}

TEST(TruthWarpTest, AStretchShowsItsRatioWhicheverWayItIsTurned) {
    const Eigen::Matrix2d stretch =
        Turn(0.3) * Eigen::DiagonalMatrix<double, 2>(1.0, 0.8) * Turn(1);
    EXPECT_NEAR(LeastCellRatio(Affine(stretch, {0, 0}), WarpGrid(12, 20, 16)), 0.8, 1e-9);
    EXPECT_NEAR(AffineRatio(Affine(stretch, {0, 0})), 0.8, 1e-9);
}

TEST(TruthWarpTest, ACornerPulledBeyondItsNeighbourFoldsTheCellsThatItTurnsOver) {
    WarpGrid warp = Affine(Eigen::Matrix2d::Identity(), {0, 0});
    warp.motion_px[warp.At(5, 7)] = {24, 0};  // past the corner to its right
    // Its lower and upper triangle in the two cells to the right.
    EXPECT_EQ(FoldedCells(warp), 2);
    warp.motion_px[warp.At(5, 7)] = {12, 0};
    EXPECT_EQ(FoldedCells(warp), 0);
}

TEST(TruthWarpTest, CellsWithoutDataAndCellsOfTheOverlapDoNotCount) {
    WarpGrid warp = Affine(Eigen::Matrix2d::Identity(), {0, 0});
    warp.motion_px[warp.At(5, 7)] = {24, 0};
    EXPECT_LT(LeastCellRatio(warp, WarpGrid(12, 20, 16)), 0.5);
    EXPECT_NEAR(LeastCellRatio(warp, warp), 1, 1e-9);
    warp.known[warp.At(5, 7)] = 0;
    EXPECT_EQ(FoldedCells(warp), 0);
}

/// A whole ring whose rays are turned, and one vertex pulled beside that.
WarpGrid TurnedRing(const algo::Projection& ring, const Vector2d& pull_px) {
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 1, 0).normalized()))
                                     .toRotationMatrix();
    WarpGrid warp(ring.height_px / 16 + 1, ring.width_px / 16, 16);
    for (int row = 0; row < warp.rows; ++row) {
        for (int col = 0; col < warp.cols; ++col) {
            const Vector2d from(col * 16 - 0.5, row * 16 - 0.5);
            warp.motion_px[warp.At(row, col)] =
                ring.Difference(ring.Pixel(turn * ring.Ray(from)), from);
            warp.known[warp.At(row, col)] = 1;
        }
    }
    warp.motion_px[warp.At(9, 40)] += pull_px;
    return warp;
}

TEST(TruthWarpTest, ATurnOfTheWholeUnitIsNoDistortionButAPullBesideItIs) {
    const auto ring = algo::Projection::Cylinder(2048, 360, 0.48);
    const WarpGrid turned = TurnedRing(ring, {0, 0});
    const WarpGrid nothing(turned.rows, turned.cols, 16);
    EXPECT_LT(LeastCellRatio(turned, nothing), 0.98);
    EXPECT_GT(LeastCellRatio(WithoutTurn(turned, ring), nothing), 1 - 1e-6);
    const WarpGrid pulled = WithoutTurn(TurnedRing(ring, {3, 0}), ring);
    EXPECT_LT(LeastCellRatio(pulled, nothing), 0.95);
}

TEST(TruthSeamTest, TheWaitRunsFromTheOverlapsReturnToTheLock) {
    TruthSeam seam;
    const auto run = [&](int frames, bool there, algo::SeamState state) {
        for (int i = 0; i < frames; ++i) seam.Observe(there, state);
    };
    run(10, true, algo::SeamState::kLocked);
    run(5, true, algo::SeamState::kCoast);  // lost while there: no wait, but not locked
    run(20, false, algo::SeamState::kNoOverlap);
    run(3, false, algo::SeamState::kLocked);
    run(7, true, algo::SeamState::kReacquire);
    run(8, true, algo::SeamState::kLocked);
    const TruthSeam::Figures figures = seam.figures();
    EXPECT_EQ(figures.appearances, 2);
    EXPECT_EQ(figures.longest_wait, 7);
    EXPECT_EQ(figures.frames_there, 30);
    EXPECT_EQ(figures.frames_locked, 18);
    EXPECT_EQ(figures.frames_locked_away, 3);
}

TEST(TruthSeamTest, OnlyJumpsOfTheOwnHalfBetweenLockedFramesCount) {
    algo::Composition composition;
    composition.seams[algo::Overlap::kLeft] = algo::SeamState::kLocked;
    FieldJump left;
    left.Observe(algo::Overlap::kLeft, composition);
    composition.discrepancy.col(algo::Mesh::Index(4, 5)) << 3, 4;
    composition.discrepancy.col(algo::Mesh::Index(4, 25)) << 30, 40;
    left.Observe(algo::Overlap::kLeft, composition);
    EXPECT_DOUBLE_EQ(left.largest_px(), 5);
    composition.seams[algo::Overlap::kLeft] = algo::SeamState::kCoast;
    composition.discrepancy.setZero();
    composition.discrepancy.col(algo::Mesh::Index(4, 5)) << 90, 0;
    left.Observe(algo::Overlap::kLeft, composition);
    EXPECT_DOUBLE_EQ(left.largest_px(), 5);
}

/// A rig that stands still in an empty world, and perhaps a truck that passes on its left.
class PassedRig {
 public:
    static constexpr int kFrames = 150;

    explicit PassedRig(std::optional<double> truck_mps) : rig_(tests::Rig(Options(truck_mps))) {
        geometry_.canvas = algo::Projection::Cylinder(2048, 360, 0.48);
        algo::PerUnit<std::vector<algo::CameraGeometry>> cameras;
        for (int i = 0; i < drivers::SimulatedRig::kCameras; ++i)
            cameras[rig_->camera(i).unit].push_back(rig_->camera(i).geometry);
        for (const algo::Unit unit : algo::kUnits) {
            geometry_.units[unit] =
                algo::UnitGeometry::Ring(geometry_.canvas, cameras[unit], algo::AlignmentSurface{});
        }
    }

    /// The canvas pans by `pan_px` per frame.
    [[nodiscard]] TruthPath::Shake TractorsShake(double pan_px) const {
        TruthSight sight(*rig_, geometry_);
        TruthPath path(sight, kRate_hz);
        algo::Composition composition;
        for (int frame = 0; frame < kFrames; ++frame) {
            composition.M_canvas_view[algo::Unit::kTractor] =
                algo::ToPose(geometry_.canvas, {{pan_px * frame, 0, 0}});
            path.Observe(frame, composition);
        }
        return path.ShakeOf(algo::Unit::kTractor);
    }

 private:
    static drivers::SimulationOptions Options(std::optional<double> truck_mps) {
        drivers::SimulationOptions options;
        options.frames = kFrames;
        options.width_px = 192;
        options.height_px = 108;
        options.speed_mps = 0;
        options.profile = drivers::DriveProfile::kStraight;
        for (const algo::Unit unit : algo::kUnits) options.shake[unit].scale = 0;
        options.scene.density = 0;
        if (truck_mps) {  // beside the rig in the middle of the drive
            const double start_m = -0.5 * *truck_mps * kFrames / kRate_hz;
            options.scene.trucks = {{.start_m = start_m, .across_m = 3.6, .speed_mps = *truck_mps}};
        }
        return options;
    }

    std::unique_ptr<drivers::SimulatedRig> rig_;
    RigGeometry geometry_;
};

TEST(TruthPathTest, WhatIsHiddenForUpToHalfASecondIsFollowedStraightOver) {
    const TruthPath::Shake free = PassedRig(std::nullopt).TractorsShake(1.5);
    const TruthPath::Shake passed = PassedRig(50).TractorsShake(1.5);
    ASSERT_GT(free.samples, 10 * PassedRig::kFrames);
    // Ten frames behind 16 m of truck at 50 m/s; the landmark nearly ahead is hidden for 17.
    EXPECT_LE(free.samples - passed.samples, 17);
    EXPECT_LT(passed.largest_px, 1e-3) << "a gap would be a jump of fifteen pixels";
    EXPECT_LT(passed.output_px, 1e-3);
}

TEST(TruthPathTest, WhatIsHiddenForLongerIsAnotherPathAfterwards) {
    const TruthPath::Shake free = PassedRig(std::nullopt).TractorsShake(1.5);
    const TruthPath::Shake passed = PassedRig(12).TractorsShake(1.5);
    EXPECT_LT(passed.samples, free.samples - 5 * 40) << "16 m of truck at 12 m/s: forty frames";
    EXPECT_GT(passed.samples, free.samples / 3);
    EXPECT_LT(passed.largest_px, 1e-3);
}

}  // namespace
}  // namespace hitchview::app
