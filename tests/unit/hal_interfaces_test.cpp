#include <gtest/gtest.h>

#include "hal/fake_camera.hpp"
#include "hal/publisher.hpp"

namespace hitchview::hal {
namespace {

TEST(CameraTest, OneThatDoesNotSayOtherwiseCannotBeReopened) {
    FakeCamera camera({.width_px = 4, .height_px = 2}, {});
    EXPECT_EQ(camera.Reopen().error(), Error::kUnsupported);
    EXPECT_EQ(camera.loss(), CameraLoss::kDisconnected);
    EXPECT_EQ(camera.counts().delivered, 0U);
    EXPECT_EQ(camera.pool().slots, 0);
}

/// Refuses what every publisher must carry, and says nothing of the rest.
class RefusingPublisher final : public Publisher {
    Result<Done> DoPublish(const PanoramaImage& /*image*/) override { return Error::kFailed; }
    Result<Done> DoPublish(const PanoramaStatus& /*status*/) override { return Error::kFailed; }
    Result<Done> DoPublish(const HitchAngle& /*angle*/) override { return Error::kFailed; }
    Result<Done> DoPublish(const Event& /*event*/) override { return Error::kFailed; }
};

TEST(PublisherTest, WhatItDoesNotCarryIsDoneAtOnce) {
    RefusingPublisher publisher;
    EXPECT_FALSE(publisher.Publish(Event{}));
    EXPECT_TRUE(publisher.Publish(Health{}));
    EXPECT_TRUE(publisher.Publish(ViewportImage{}));
    EXPECT_TRUE(publisher.Publish(PreviewImage{}));
    EXPECT_TRUE(publisher.Publish(Overlay{}));
}

}  // namespace
}  // namespace hitchview::hal
