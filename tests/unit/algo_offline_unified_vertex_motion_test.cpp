#include <gtest/gtest.h>

#include <numbers>

#include "algo/offline_unified_vertex_motion.hpp"
#include "tests/support/flat_world.hpp"
#include "tests/support/shaky_profiles.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

constexpr int kFrames = 40;
const cv::Size kView{320, 200};
const Projection kCanvas = Projection::Plane(620, 280);

/// Two windows on one flat picture without end, side by side with an overlap, each with its own
/// shake; the trailer's also swings to the side and back. Whole pixels.
class ShakingWindows {
 public:
    ShakingWindows() {
        cv::RNG random(6);
        for (int i = 0; i < kFrames; ++i) {
            const auto shake = [&] { return random.uniform(-4, 5); };
            const int swing =
                static_cast<int>(std::lround(10 * std::sin(std::numbers::pi * i / kFrames)));
            corner_[Unit::kTractor].emplace_back(40 + shake(), 50 + shake());
            corner_[Unit::kTrailer].emplace_back(250 + shake() - swing, 54 + shake());
        }
    }

    /// Learns all frames and solves.
    [[nodiscard]] std::vector<Composition> Solve(OfflineOptions options, bool two_units = true) {
        PerUnit<std::optional<UnitGeometry>> geometry;
        geometry[Unit::kTractor] = UnitGeometry::Plane(kView.width, kView.height);
        if (two_units) geometry[Unit::kTrailer] = geometry[Unit::kTractor];
        OfflineUnifiedVertexMotion sut(kCanvas, geometry, options);
        SerialRunner runner;
        EXPECT_TRUE(sut.Prime(Look(0).frames, runner));
        for (int i = 0; i < kFrames; ++i) sut.Learn(Look(i).frames, runner);
        sut.Solve();
        std::vector<Composition> compositions;
        while (const Composition* c = sut.Step({}, runner)) compositions.push_back(*c);
        return compositions;
    }

    /// Where a point of the world is shown by a unit, frame by frame: columns x and y.
    [[nodiscard]] Profiles Shown(const std::vector<Composition>& compositions, Unit unit,
                                 const Vector2d& world_px) const {
        const Projection view = Projection::Plane(kView.width, kView.height);
        Profiles shown(kFrames, 2);
        for (int i = 0; i < kFrames; ++i) {
            const cv::Point corner = corner_[unit][static_cast<std::size_t>(i)];
            const Vector2d in_view = world_px - Vector2d(corner.x, corner.y);
            shown.row(i) = ToCanvas(kCanvas, view, compositions[static_cast<std::size_t>(i)], unit,
                                    view.Ray(in_view));
        }
        return shown;
    }

 private:
    [[nodiscard]] tests::PlaneFrames Look(int frame) const {
        const auto i = static_cast<std::size_t>(frame);
        return world_.Look({{corner_[Unit::kTractor][i], corner_[Unit::kTrailer][i]}});
    }

    tests::FlatWorld world_{kView, 3};
    PerUnit<std::vector<cv::Point>> corner_;
};

const Vector2d kInTheOverlap{305, 150};
const Vector2d kInTheTractorAlone{140, 150};
const Vector2d kInTheTrailerAlone{470, 150};

double Jitter(const Profiles& shown) {
    return std::max(tests::Jitter(shown.col(0)), tests::Jitter(shown.col(1)));
}

class OfflineUnifiedVertexMotionTest : public testing::Test {
 protected:
    ShakingWindows windows_;
};

TEST_F(OfflineUnifiedVertexMotionTest, CorrectedBothViewsAreAlignedAndSteadyEverywhere) {
    const auto found = windows_.Solve({});
    ASSERT_EQ(found.size(), kFrames);
    const Profiles tractor = windows_.Shown(found, Unit::kTractor, kInTheOverlap);
    const Profiles trailer = windows_.Shown(found, Unit::kTrailer, kInTheOverlap);
    EXPECT_LT(tests::Rms(tractor - trailer), 0.3);
    for (const auto& [unit, point] :
         {std::pair{Unit::kTractor, kInTheOverlap}, std::pair{Unit::kTrailer, kInTheOverlap},
          std::pair{Unit::kTractor, kInTheTractorAlone},
          std::pair{Unit::kTrailer, kInTheTrailerAlone}}) {
        EXPECT_LT(Jitter(windows_.Shown(found, unit, point)), 1.0) << "the input has 6 px";
    }
}

TEST_F(OfflineUnifiedVertexMotionTest, LiterallyTheViewsAreAlignedAndShakeOn) {
    const auto found = windows_.Solve({.coupling = Coupling::kLiteral});
    const Profiles tractor = windows_.Shown(found, Unit::kTractor, kInTheOverlap);
    const Profiles trailer = windows_.Shown(found, Unit::kTrailer, kInTheOverlap);
    EXPECT_LT(tests::Rms(tractor - trailer), 0.3);
    EXPECT_GT(Jitter(tractor), 4.0);
    EXPECT_GT(Jitter(windows_.Shown(found, Unit::kTractor, kInTheTractorAlone)), 4.0);
}

TEST_F(OfflineUnifiedVertexMotionTest, ASingleUnitIsSteadiedWhateverTheCoupling) {
    for (const Coupling coupling : {Coupling::kCorrected, Coupling::kLiteral}) {
        const auto found = windows_.Solve({.coupling = coupling}, false);
        EXPECT_LT(Jitter(windows_.Shown(found, Unit::kTractor, kInTheTractorAlone)), 1.0);
    }
}

TEST_F(OfflineUnifiedVertexMotionTest, WithoutStabilisationTheTractorStaysWhereItIs) {
    OfflineOptions options;
    options.motion.stabilize = false;
    for (const Composition& c : windows_.Solve(options)) {
        EXPECT_TRUE(c.M_canvas_view[Unit::kTractor].topLeftCorner(2, 2).isIdentity(1e-9));
        EXPECT_LT(c.view_offset[Unit::kTractor].cwiseAbs().maxCoeff(), 1e-6);
    }
}

TEST_F(OfflineUnifiedVertexMotionTest, TheSecondPassCanBeStartedAgain) {
    PerUnit<std::optional<UnitGeometry>> geometry;
    geometry[Unit::kTractor] = UnitGeometry::Plane(kView.width, kView.height);
    OfflineUnifiedVertexMotion sut(kCanvas, geometry, {});
    SerialRunner runner;
    sut.Learn({}, runner);
    sut.Learn({}, runner);
    sut.Solve();
    EXPECT_FALSE(sut.LightenNextStep()) << "it has all the time there is";
    for (int pass = 0; pass < 2; ++pass) {
        EXPECT_NE(sut.Step({}, runner), nullptr);
        EXPECT_NE(sut.Step({}, runner), nullptr);
        EXPECT_EQ(sut.Step({}, runner), nullptr);
        EXPECT_EQ(sut.Flush(), nullptr);
        sut.Reset();
    }
}

}  // namespace
}  // namespace hitchview::algo
