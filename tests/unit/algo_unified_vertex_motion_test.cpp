#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "algo/unified_vertex_motion.hpp"
#include "tests/support/flat_world.hpp"
#include "tests/support/shaky_profiles.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2d;

constexpr int kFrames = 60;
/// The smoother learns how fast things are from the first ones.
constexpr int kSettled = 20;
const cv::Size kView{320, 200};
const Projection kPlane = Projection::Plane(kView.width, kView.height);
const Projection kCanvas = Projection::Plane(620, 280);
/// Points of the world.
const Vector2d kInTheOverlap{305, 160};
const Vector2d kInTheTractorAlone{140, 160};
const Vector2d kInTheTrailerAlone{470, 160};

using Corners = PerUnit<std::optional<cv::Point>>;
using Compositions = std::vector<Composition>;

UnifiedVertexMotionOptions Lookahead(int frames) {
    UnifiedVertexMotionOptions options;
    options.lookahead_frames = frames;
    return options;
}

/// Both units shake, each on its own; `kPan` px per frame are meant.
std::vector<Corners> ShakyDrive() {
    constexpr double kPan = 0.5;
    cv::RNG random(6);
    const auto shake = [&] { return random.uniform(-4, 5); };
    std::vector<Corners> drive;
    for (int i = 0; i < kFrames; ++i) {
        const int pan = static_cast<int>(kPan * i);
        drive.push_back({{cv::Point(40 + pan + shake(), 60 + shake()),
                          cv::Point(250 + pan + shake(), 64 + shake())}});
    }
    return drive;
}

class UnifiedVertexMotionTest : public testing::Test {
 protected:
    static std::unique_ptr<UnifiedVertexMotion> Motion(
        const UnifiedVertexMotionOptions& options = {}, bool two_units = true) {
        PerUnit<std::optional<UnitGeometry>> geometry;
        geometry[Unit::kTractor] = UnitGeometry::Plane(kView.width, kView.height);
        if (two_units) geometry[Unit::kTrailer] = geometry[Unit::kTractor];
        return std::make_unique<UnifiedVertexMotion>(kCanvas, geometry, options);
    }
    bool Prime(UnifiedVertexMotion& sut) {
        return sut.Prime(world_.Look(drive_[0]).frames, runner_);
    }
    const Composition* Step(UnifiedVertexMotion& sut, const Corners& corners) {
        return sut.Step(world_.Look(corners).frames, runner_);
    }
    Compositions Drive(UnifiedVertexMotion& sut) {
        Compositions compositions;
        for (const Corners& corners : drive_) {
            if (const Composition* c = Step(sut, corners)) compositions.push_back(*c);
        }
        while (const Composition* c = sut.Flush()) compositions.push_back(*c);
        return compositions;
    }
    Compositions Primed(const UnifiedVertexMotionOptions& options = {}) {
        const auto sut = Motion(options);
        EXPECT_TRUE(Prime(*sut));
        return Drive(*sut);
    }

    /// Where a point of the world is shown by a unit from frame `first` on: columns x and y.
    [[nodiscard]] Profiles Shown(const Compositions& compositions, Unit unit,
                                 const Vector2d& world_px, int first = kSettled) const {
        Profiles shown(kFrames - first, 2);
        for (int i = first; i < kFrames; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const cv::Point corner = *drive_[at][unit];
            const Vector2d in_view = world_px - Vector2d(corner.x, corner.y);
            shown.row(i - first) =
                ToCanvas(kCanvas, kPlane, compositions[at], unit, kPlane.Ray(in_view));
        }
        return shown;
    }
    /// Root mean square distance between the two units' places for one point of the world.
    [[nodiscard]] double Misalignment(const Compositions& compositions) const {
        return tests::Rms(Shown(compositions, Unit::kTractor, kInTheOverlap, 1) -
                          Shown(compositions, Unit::kTrailer, kInTheOverlap, 1));
    }

    tests::FlatWorld world_{kView, 3};
    std::vector<Corners> drive_ = ShakyDrive();
    SerialRunner runner_;
};

double Jitter(const Profiles& shown) {
    return std::max(tests::Jitter(shown.col(0)), tests::Jitter(shown.col(1)));
}

TEST_F(UnifiedVertexMotionTest, BothViewsAreAlignedAndSteadyEverywhere) {
    const Compositions found = Primed();
    ASSERT_EQ(found.size(), kFrames);
    EXPECT_LT(Misalignment(found), 0.5);
    for (const auto& [unit, point] :
         {std::pair{Unit::kTractor, kInTheOverlap}, std::pair{Unit::kTrailer, kInTheOverlap},
          std::pair{Unit::kTractor, kInTheTractorAlone},
          std::pair{Unit::kTrailer, kInTheTrailerAlone}}) {
        EXPECT_LT(Jitter(Shown(found, unit, point)), 0.5) << "the input has 6 px";
    }
    for (const Composition& c : found) EXPECT_EQ(c.seams[Overlap::kRight], SeamState::kLocked);
}

TEST_F(UnifiedVertexMotionTest, WhereTheBorderStaysCoveredLookaheadMakesItSteadier) {
    UnifiedVertexMotionOptions options;
    options.border = Border::kCovered;
    const double without = Jitter(Shown(Primed(options), Unit::kTractor, kInTheTractorAlone));
    options.lookahead_frames = 8;
    const double with = Jitter(Shown(Primed(options), Unit::kTractor, kInTheTractorAlone));
    EXPECT_LT(with, 0.7 * without);
}

TEST_F(UnifiedVertexMotionTest, LookaheadHoldsBackThatManyAndEachIsOfItsOwnFrame) {
    constexpr int kLookahead = 3;
    const auto sut = Motion(Lookahead(kLookahead));
    ASSERT_TRUE(Prime(*sut));
    Compositions found;
    for (int i = 0; i < kFrames; ++i) {
        const Composition* c = Step(*sut, drive_[static_cast<std::size_t>(i)]);
        ASSERT_EQ(c != nullptr, i >= kLookahead) << i;
        if (c != nullptr) found.push_back(*c);
    }
    for (int i = 0; i < kLookahead; ++i) {
        const Composition* c = sut->Flush();
        ASSERT_NE(c, nullptr);
        found.push_back(*c);
    }
    EXPECT_EQ(sut->Flush(), nullptr);
    // A composition for another frame would be as far off as the shake is.
    EXPECT_LT(Misalignment(found), 0.5);
}

TEST_F(UnifiedVertexMotionTest, WithoutStabilisationTheTractorStaysAndTheTrailerFollowsIt) {
    UnifiedVertexMotionOptions options;
    options.stabilize = false;
    const Compositions found = Primed(options);
    for (const Composition& c : found)
        EXPECT_EQ(c.M_canvas_view[Unit::kTractor], found[0].M_canvas_view[Unit::kTractor]);
    EXPECT_LT(Misalignment(found), 0.5);
}

TEST_F(UnifiedVertexMotionTest, WithoutStitchingTheViewsStandApartAndAreSteadied) {
    UnifiedVertexMotionOptions options;
    options.stitch = false;
    const Compositions found = Primed(options);
    for (const Composition& c : found) {
        EXPECT_EQ(c.seams[Overlap::kRight], SeamState::kNoOverlap);
        EXPECT_TRUE(c.discrepancy.isZero(0));
    }
    EXPECT_LT(Jitter(Shown(found, Unit::kTrailer, kInTheTrailerAlone)), 0.5);
    EXPECT_GT(Misalignment(found), 50);
}

TEST_F(UnifiedVertexMotionTest, AUnitAloneIsSteadied) {
    const auto sut = Motion({}, false);
    EXPECT_FALSE(sut->has_trailer());
    EXPECT_TRUE(Prime(*sut));
    EXPECT_LT(Jitter(Shown(Drive(*sut), Unit::kTractor, kInTheTractorAlone)), 0.5);
}

TEST_F(UnifiedVertexMotionTest, WhileATrailerGivesNoPictureTheTractorIsSteadiedAndBothMeetAgain) {
    const auto whole = drive_;
    for (std::size_t i = 25; i < 30; ++i) drive_[i][Unit::kTrailer].reset();
    const Compositions found = Primed();
    ASSERT_EQ(found.size(), kFrames);
    for (std::size_t i = 25; i < 30; ++i)
        EXPECT_NE(found[i].seams[Overlap::kRight], SeamState::kLocked) << i;
    EXPECT_LT(Jitter(Shown(found, Unit::kTractor, kInTheTractorAlone)), 0.5);

    drive_ = whole;
    const Profiles apart = Shown(found, Unit::kTractor, kInTheOverlap, 40) -
                           Shown(found, Unit::kTrailer, kInTheOverlap, 40);
    EXPECT_LT(tests::Rms(apart), 0.5);
    EXPECT_EQ(found.back().seams[Overlap::kRight], SeamState::kLocked);
}

TEST_F(UnifiedVertexMotionTest, AfterAResetTheSameFramesGiveTheSameCompositions) {
    const auto sut = Motion(Lookahead(2), false);
    ASSERT_TRUE(Prime(*sut));
    const Compositions once = Drive(*sut);
    sut->Reset();
    const Compositions again = Drive(*sut);
    ASSERT_EQ(once.size(), again.size());
    for (std::size_t i = 0; i < once.size(); ++i) {
        EXPECT_TRUE(once[i].M_canvas_view[Unit::kTractor].isApprox(
            again[i].M_canvas_view[Unit::kTractor], 1e-5))
            << i;
    }
}

TEST_F(UnifiedVertexMotionTest, AStepMayLeaveOutMatchingButNotTwiceInARow) {
    const auto sut = Motion();
    const auto full = Motion();
    ASSERT_TRUE(Prime(*sut));
    ASSERT_TRUE(Prime(*full));
    EXPECT_FALSE(sut->LightenNextStep()) << "nothing was matched yet";
    int lightened = 0;
    for (const Corners& corners : drive_) {
        const bool light = sut->LightenNextStep();
        lightened += light ? 1 : 0;
        const Composition& c = *Step(*sut, corners);
        const Composition& expected = *Step(*full, corners);
        EXPECT_EQ(c.seams[Overlap::kRight], SeamState::kLocked);
        const Vector2d at = kInTheOverlap - Vector2d(250, 64);
        const Vector2d shown = (c.M_canvas_view[Unit::kTrailer] * at.homogeneous()).hnormalized();
        const Vector2d wanted =
            (expected.M_canvas_view[Unit::kTrailer] * at.homogeneous()).hnormalized();
        EXPECT_LT((shown - wanted).norm(), 1.0) << "the placement is predicted";
    }
    EXPECT_EQ(lightened, kFrames / 2);
}

TEST_F(UnifiedVertexMotionTest, OneUnitAloneHasNothingToLeaveOut) {
    const auto sut = Motion({}, false);
    Step(*sut, drive_[0]);
    EXPECT_FALSE(sut->LightenNextStep());
}

}  // namespace
}  // namespace hitchview::algo
