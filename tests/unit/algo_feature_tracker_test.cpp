#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "algo/feature_tracker.hpp"
#include "tests/support/sine_texture.hpp"

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

const cv::Size kSize(400, 280);

GreyPyramid PyramidOf(const cv::Mat1b& picture) {
    GreyPyramid pyramid(picture.cols, picture.rows);
    picture.copyTo(pyramid.base());
    pyramid.Build();
    return pyramid;
}

class FeatureTrackerTest : public testing::Test {
 protected:
    /// Shows the next frame to the tracker.
    const FeatureTracker::Tracks& Show(const cv::Mat1b& picture) {
        GreyPyramid next = PyramidOf(picture);
        swap(early_, late_);
        swap(late_, next);
        tracker_.Follow(early_, late_, mask_, tracks_);
        return tracks_;
    }

    FeatureTrackerOptions options_{.features = 150};
    FeatureTracker tracker_{kSize.width, kSize.height, options_};
    FeatureTracker::Tracks tracks_;
    cv::Mat1b mask_{kSize, std::uint8_t{255}};
    GreyPyramid early_{kSize.width, kSize.height};
    GreyPyramid late_{kSize.width, kSize.height};
    tests::SineTexture world_{31};
};

TEST_F(FeatureTrackerTest, TheFirstFrameGivesFeaturesButNoTracks) {
    EXPECT_TRUE(Show(world_.Shifted(kSize, 0, 0)).empty());
    EXPECT_GT(tracker_.features().size(), 100U);
}

TEST_F(FeatureTrackerTest, EveryTrackOfAMovingWorldHasItsMotionFrameAfterFrame) {
    const Vector2f step{3.7F, -2.2F};
    for (int i = 0; i < 5; ++i) {
        const Vector2f at = step * static_cast<float>(i);
        const auto& tracks = Show(world_.Shifted(kSize, at.x(), at.y()));
        if (i == 0) continue;
        ASSERT_GT(tracks.count(), 80) << "frame " << i;
        for (const auto& track : tracks) {
            EXPECT_LT((track.late_px - track.early_px - step).norm(), 0.1F)
                << "frame " << i << " at " << track.early_px.transpose();
        }
    }
}

TEST_F(FeatureTrackerTest, ATurningWorldIsFollowed) {
    const double turn = 0.01;
    const auto turned = [&](double angle) {
        return world_.Picture(kSize, [&](int x, int y) {
            const double u = x - 200;
            const double v = y - 140;
            return cv::Vec2d(std::cos(angle) * u + std::sin(angle) * v,
                             -std::sin(angle) * u + std::cos(angle) * v);
        });
    };
    Show(turned(0));
    const auto& tracks = Show(turned(turn));
    ASSERT_GT(tracks.count(), 80);
    const Eigen::Rotation2D<float> expected(static_cast<float>(turn));
    const Vector2f centre{200, 140};
    for (const auto& track : tracks) {
        const Vector2f there = centre + expected * (track.early_px - centre);
        EXPECT_LT((track.late_px - there).norm(), 0.15F);
    }
}

TEST_F(FeatureTrackerTest, FeaturesUnderAnOccluderAreDroppedAndThoseOnItFollowIt) {
    const tests::SineTexture other(77, 9, 36);
    const Vector2f ground_motion{2, 1};
    const Vector2f square_motion{-6, 3};
    const auto square = [&](float t) {
        const Vector2f corner = Vector2f{170, 90} + t * square_motion;
        return cv::Rect(static_cast<int>(corner.x()), static_cast<int>(corner.y()), 90, 90);
    };
    const auto frame = [&](float t) {
        cv::Mat1b picture = world_.Shifted(kSize, t * ground_motion.x(), t * ground_motion.y());
        const cv::Mat1b cover = other.Shifted(kSize, t * square_motion.x(), t * square_motion.y());
        cover(square(t)).copyTo(picture(square(t)));
        return picture;
    };
    Show(frame(0));
    const FeatureTracker::Tracks tracks = Show(frame(1));
    int on_square = 0;
    int on_ground = 0;
    int neither = 0;
    for (const auto& track : tracks) {
        const Vector2f motion = track.late_px - track.early_px;
        if ((motion - square_motion).norm() < 0.1F)
            ++on_square;
        else if ((motion - ground_motion).norm() < 0.1F)
            ++on_ground;
        else
            ++neither;
    }
    EXPECT_GT(on_square, 4);
    EXPECT_GT(on_ground, 60);
    // Only patches that lie across the edge of the square may mix the two motions.
    EXPECT_LT(neither, 0.06 * tracks.count());
}

TEST_F(FeatureTrackerTest, ACutToAnotherWorldKeepsFewTracks) {
    Show(world_.Shifted(kSize, 0, 0));
    const auto at_first = static_cast<double>(tracker_.features().size());
    EXPECT_LT(Show(tests::SineTexture(99).Shifted(kSize, 0, 0)).count(), 0.2 * at_first);
}

TEST_F(FeatureTrackerTest, NoFeatureLiesWhereTheMaskForbidsIt) {
    mask_(cv::Rect(0, 0, 200, kSize.height)).setTo(0);
    for (int i = 0; i < 3; ++i) {
        for (const auto& track : Show(world_.Shifted(kSize, -4.0 * i, 0))) {
            EXPECT_GE(track.late_px.x(), 199.5F);
        }
        for (const Vector2f& feature : tracker_.features()) EXPECT_GE(feature.x(), 199.5F);
    }
}

TEST_F(FeatureTrackerTest, LostFeaturesAreReplacedByNewOnes) {
    Show(world_.Shifted(kSize, 0, 0));
    const std::size_t at_first = tracker_.features().size();
    for (int i = 1; i < 8; ++i) Show(world_.Shifted(kSize, 13.0 * i, 0));
    EXPECT_GT(static_cast<double>(tracker_.features().size()),
              0.85 * static_cast<double>(at_first));
    const auto new_ones = std::count_if(tracker_.features().begin(), tracker_.features().end(),
                                        [](const Vector2f& feature) { return feature.x() < 90; });
    EXPECT_GE(new_ones, 5);
}

TEST_F(FeatureTrackerTest, AfterResetTheNextFrameGivesNoTracks) {
    Show(world_.Shifted(kSize, 0, 0));
    ASSERT_FALSE(Show(world_.Shifted(kSize, 1, 0)).empty());
    tracker_.Reset();
    EXPECT_TRUE(tracker_.features().empty());
    EXPECT_TRUE(Show(world_.Shifted(kSize, 2, 0)).empty());
    EXPECT_FALSE(Show(world_.Shifted(kSize, 3, 0)).empty());
}

}  // namespace
}  // namespace hitchview::algo
