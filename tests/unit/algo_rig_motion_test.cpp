#include <gtest/gtest.h>

#include <memory>

#include "algo/rig_motion.hpp"
#include "tests/support/flat_world.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr int kCoastFrames = 60;
const cv::Size kView{320, 200};
const Projection kCanvas = Projection::Plane(620, 280);
const cv::Point kTractorAt{60, 60};
const cv::Point kTrailerAt{260, 66};

using Corners = PerUnit<std::optional<cv::Point>>;

Vector2d Moved(const Matrix3d& M, const Vector2d& pixel) {
    return (M * pixel.homogeneous()).hnormalized();
}

class RigMotionTest : public testing::Test {
 protected:
    static PerUnit<std::optional<UnitGeometry>> Geometry() {
        const UnitGeometry plane = UnitGeometry::Plane(kView.width, kView.height);
        return {{plane, plane}};
    }
    static std::unique_ptr<RigMotionEstimator> Estimator(
        const UnifiedVertexMotionOptions& options = {}) {
        return std::make_unique<RigMotionEstimator>(kCanvas, Geometry(), options);
    }

    bool Prime(const Corners& corners) { return sut_->Prime(world_.Look(corners).frames, runner_); }
    const RigMotion& Estimate(const Corners& corners) { return Estimate(world_.Look(corners)); }
    const RigMotion& Estimate(const tests::PlaneFrames& set) {
        sut_->Estimate(set.frames, guess_, runner_, *motion_);
        return *motion_;
    }
    /// Both where they stand at first; the trailer looks at another world.
    tests::PlaneFrames TrailerCovered() {
        tests::PlaneFrames set = world_.Look({{kTractorAt, std::nullopt}});
        const tests::PlaneFrames cover = other_world_.Look({{std::nullopt, kTrailerAt}});
        set.pictures.push_back(cover.pictures[0]);
        set.frames[Unit::kTrailer][0] = set.pictures.back().frame();
        return set;
    }

    tests::FlatWorld world_{kView, 3};
    tests::FlatWorld other_world_{kView, 4};
    const Corners both_{{kTractorAt, kTrailerAt}};
    SerialRunner runner_;
    MatchGuess guess_;
    std::unique_ptr<RigMotion> motion_ = std::make_unique<RigMotion>();
    std::unique_ptr<RigMotionEstimator> sut_ = Estimator();
};

TEST_F(RigMotionTest, OneFrameSetTellsWhereTheTrailersViewLiesOnTheTractors) {
    EXPECT_EQ(sut_->M_tractor_trailer(), nullptr);
    ASSERT_TRUE(Prime(both_));
    ASSERT_NE(sut_->M_tractor_trailer(), nullptr);
    for (const Vector2d& pixel : {Vector2d(10, 20), Vector2d(110, 180)}) {  // in the overlap
        EXPECT_LT((Moved(*sut_->M_tractor_trailer(), pixel) - pixel - Vector2d(200, 6)).norm(),
                  0.3);
    }
}

TEST_F(RigMotionTest, TheTrailerIsNotFoundInAnotherWorld) {
    EXPECT_FALSE(sut_->Prime(TrailerCovered().frames, runner_));
    EXPECT_EQ(sut_->M_tractor_trailer(), nullptr);
    const RigMotion& motion = Estimate(TrailerCovered());
    EXPECT_FALSE(motion.placed);
    EXPECT_EQ(motion.seams[Overlap::kRight], SeamState::kNoOverlap);
}

TEST_F(RigMotionTest, WhoDoesNotStitchNeedsNoTrailer) {
    UnifiedVertexMotionOptions options;
    options.stitch = false;
    sut_ = Estimator(options);
    EXPECT_TRUE(sut_->Prime(TrailerCovered().frames, runner_));
    EXPECT_FALSE(Estimate(both_).placed);
}

TEST_F(RigMotionTest, EachUnitsMotionIsItsOwn) {
    ASSERT_TRUE(Prime(both_));
    Estimate(both_);
    const RigMotion& motion = Estimate({{kTractorAt + cv::Point(5, -3), kTrailerAt}});
    for (const Vector2d& pixel : {Vector2d(0, 0), Vector2d(319, 0), Vector2d(160, 199)}) {
        const auto moved = [&](Unit unit) {
            return Vector2d(Moved(motion.intra[unit].M_late_early, pixel) - pixel);
        };
        EXPECT_LT((moved(Unit::kTractor) - Vector2d(-5, 3)).norm(), 0.1);
        EXPECT_LT(moved(Unit::kTrailer).norm(), 0.1);
    }
    EXPECT_LT(motion.intra[Unit::kTractor].residual.cwiseAbs().maxCoeff(), 0.2F);
}

TEST_F(RigMotionTest, PairsAndPlacementFollowTheUnitsFromFrameToFrame) {
    ASSERT_TRUE(Prime(both_));
    Estimate(both_);
    for (const int x : {7, -6, 9, 0}) {
        const RigMotion& motion = Estimate({{kTractorAt, kTrailerAt + cv::Point(x, x / 2)}});
        const Vector2d apart(200 + x, 6 + x / 2);
        EXPECT_EQ(motion.seams[Overlap::kRight], SeamState::kLocked);
        EXPECT_EQ(motion.seams[Overlap::kLeft], SeamState::kNoOverlap) << "a plane has one overlap";
        EXPECT_LT((Moved(motion.M_tractor_trailer, {60, 100}) - Vector2d(60, 100) - apart).norm(),
                  0.3);
        const InterFeatures& dense = motion.dense[Overlap::kRight];
        EXPECT_GT(dense.count(), 60);
        for (const InterFeature& f : dense)
            EXPECT_LT((f.tractor_px - f.trailer_px - apart).norm(), 0.5);
    }
}

TEST_F(RigMotionTest, AUnitWithoutAPictureStandsStillAndTheOtherOneGoesOn) {
    ASSERT_TRUE(Prime(both_));
    Estimate(both_);
    const RigMotion& motion = Estimate({{kTractorAt + cv::Point(4, 0), std::nullopt}});
    EXPECT_FALSE(motion.intra[Unit::kTrailer].known);
    EXPECT_TRUE(motion.intra[Unit::kTrailer].M_late_early.isIdentity(0));
    EXPECT_TRUE(motion.intra[Unit::kTractor].known);
    EXPECT_TRUE(motion.placed);
    EXPECT_NE(motion.seams[Overlap::kRight], SeamState::kLocked);
    // The tractor's own motion carries the placement on.
    EXPECT_LT((Moved(motion.M_tractor_trailer, {60, 100}) - Vector2d(256, 106)).norm(), 0.3);

    for (int i = 0; i < SeamHysteresis::kHold; ++i) Estimate(both_);
    EXPECT_EQ(Estimate(both_).seams[Overlap::kRight], SeamState::kLocked);
}

TEST_F(RigMotionTest, ACoveredOverlapCoastsThenIsLookedForUntilItIsSeenAgain) {
    ASSERT_TRUE(Prime(both_));
    EXPECT_EQ(Estimate(both_).seams[Overlap::kRight], SeamState::kLocked);
    const tests::PlaneFrames covered = TrailerCovered();
    for (int i = 1; i < kCoastFrames; ++i)
        ASSERT_EQ(Estimate(covered).seams[Overlap::kRight], SeamState::kCoast) << i;
    EXPECT_EQ(Estimate(covered).seams[Overlap::kRight], SeamState::kReacquire);

    const RigMotion& motion = Estimate(both_);
    EXPECT_EQ(motion.seams[Overlap::kRight], SeamState::kLocked);
    EXPECT_LT((Moved(motion.M_tractor_trailer, {60, 100}) - Vector2d(260, 106)).norm(), 0.5);
}

TEST_F(RigMotionTest, AfterAResetNothingIsKnownOfTheFrameBefore) {
    ASSERT_TRUE(Prime(both_));
    Estimate(both_);
    sut_->Reset();
    EXPECT_FALSE(Estimate(both_).intra[Unit::kTractor].known);
    EXPECT_NE(sut_->M_tractor_trailer(), nullptr) << "the placement stays";
}

}  // namespace
}  // namespace hitchview::algo
