#include <gtest/gtest.h>

#include <memory>

#include "algo/feature_matcher.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

const cv::Size kSize{320, 240};
/// Trailer minus tractor position of everything that both see.
const Vector2f kShift_px{-70.4F, 12.3F};

/// Puts everything at the true shift, `off_px` beside it.
class KnownShift final : public Expectation {
 public:
    explicit KnownShift(const Vector2f& off_px = Vector2f::Zero()) : off_px_(off_px) {}
    bool Expect(Unit unit, const Vector2f& pixel, Vector2f& other) const override {
        other = pixel + (unit == Unit::kTractor ? kShift_px : Vector2f(-kShift_px)) + off_px_;
        return other.x() > 0 && other.y() > 0 && other.x() < 320 && other.y() < 240;
    }

 private:
    Vector2f off_px_;
};

class NowhereExpected final : public Expectation {
 public:
    bool Expect(Unit, const Vector2f&, Vector2f&) const override { return false; }
};

/// Two pictures of one texture, or of two.
class FeatureMatcherTest : public testing::Test {
 protected:
    FeatureMatcherTest() {
        Show(Unit::kTractor, tests::SineTexture(5).Shifted(kSize, 0, 0));
        Show(Unit::kTrailer, tests::SineTexture(5).Shifted(kSize, kShift_px.x(), kShift_px.y()));
        for (float y = 20; y < 230; y += 14) {
            for (float x = 20; x < 310; x += 14) lattice_.emplace_back(x, y);
        }
    }

    void Show(Unit unit, const cv::Mat1b& picture) {
        picture.copyTo(pyramids_[unit].base());
        pyramids_[unit].Build();
    }
    /// Features of one unit only: the pairs that are found start there.
    [[nodiscard]] ViewPairs Guided(Unit from, const Expectation& expectation) {
        PerUnit<MatchView> views = Views();
        views[from].features = lattice_;
        const auto pairs = std::make_unique<ViewPairs>();
        sut_->Guide(views, expectation, *pairs);
        return *pairs;
    }
    [[nodiscard]] ViewPairs Acquired(const PerUnit<cv::Rect>& regions) {
        const auto pairs = std::make_unique<ViewPairs>();
        sut_->Acquire(Views(), regions, *pairs);
        return *pairs;
    }
    [[nodiscard]] PerUnit<MatchView> Views() const {
        return {{MatchView{&pyramids_[Unit::kTractor], &masks_[Unit::kTractor], {}},
                 MatchView{&pyramids_[Unit::kTrailer], &masks_[Unit::kTrailer], {}}}};
    }

    PerUnit<GreyPyramid> pyramids_{{GreyPyramid(320, 240), GreyPyramid(320, 240)}};
    PerUnit<cv::Mat1b> masks_{
        {cv::Mat1b(kSize, std::uint8_t{255}), cv::Mat1b(kSize, std::uint8_t{255})}};
    std::vector<Vector2f> lattice_;
    std::unique_ptr<ClassicalMatcher> sut_ =
        std::make_unique<ClassicalMatcher>(320, 240, ClassicalMatcherOptions{});
    const PerUnit<cv::Rect> everywhere_{{cv::Rect({0, 0}, kSize), cv::Rect({0, 0}, kSize)}};
};

/// Pairs that show the true shift to `limit_px`.
int Right(const ViewPairs& pairs, float limit_px) {
    return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), [&](const ViewPair& pair) {
        return (pair.trailer_px - pair.tractor_px - kShift_px).norm() < limit_px;
    }));
}

TEST_F(FeatureMatcherTest, GuidedEveryPairShowsTheTrueShiftFromEitherUnit) {
    for (const Unit from : kUnits) {
        const ViewPairs pairs = Guided(from, KnownShift({2.5F, -2}));
        EXPECT_GT(pairs.count(), 100) << ToString(from);
        EXPECT_EQ(Right(pairs, 0.1F), pairs.count()) << ToString(from);
    }
}

TEST_F(FeatureMatcherTest, WhatIsExpectedNowhereIsNotLookedFor) {
    EXPECT_TRUE(Guided(Unit::kTractor, NowhereExpected()).empty());
}

TEST_F(FeatureMatcherTest, NoPairEndsWhereTheOtherViewIsMaskedOut) {
    masks_[Unit::kTrailer].colRange(0, 120).setTo(0);
    const ViewPairs pairs = Guided(Unit::kTractor, KnownShift());
    EXPECT_GT(pairs.count(), 40);
    for (const ViewPair& pair : pairs) EXPECT_GT(pair.trailer_px.x(), 118);
}

TEST_F(FeatureMatcherTest, GuidedIntoAnotherWorldHardlyAnythingAgrees) {
    const int in_the_same = Guided(Unit::kTractor, KnownShift()).count();
    Show(Unit::kTrailer, tests::SineTexture(6).Shifted(kSize, 0, 0));
    EXPECT_LT(Guided(Unit::kTractor, KnownShift()).count(), 0.15 * in_the_same);
}

TEST_F(FeatureMatcherTest, FromNothingMostPairsShowTheTrueShift) {
    const ViewPairs pairs = Acquired(everywhere_);
    EXPECT_GT(pairs.count(), 60);
    EXPECT_GT(Right(pairs, 0.5F), 0.8 * pairs.count());
}

TEST_F(FeatureMatcherTest, FromNothingPairsLieInTheRegionsGiven) {
    PerUnit<cv::Rect> regions = everywhere_;
    regions[Unit::kTractor] = {160, 0, 160, 240};
    const ViewPairs pairs = Acquired(regions);
    EXPECT_GT(Right(pairs, 0.5F), 20);
    for (const ViewPair& pair : pairs) EXPECT_GT(pair.tractor_px.x(), 155);
}

TEST_F(FeatureMatcherTest, FromNothingTwoWorldsHaveNothingThatAgrees) {
    Show(Unit::kTrailer, tests::SineTexture(6).Shifted(kSize, 0, 0));
    EXPECT_LT(Right(Acquired(everywhere_), 3), 5);
}

}  // namespace
}  // namespace hitchview::algo
