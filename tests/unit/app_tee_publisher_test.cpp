#include <gtest/gtest.h>

#include <memory>

#include "app/tee_publisher.hpp"
#include "hal/fake_publisher.hpp"

namespace hitchview::app {
namespace {

/// Two receivers behind one publisher.
class TeePublisherTest : public testing::Test {
 protected:
    hal::FakePublisher* const first_ = new hal::FakePublisher;
    hal::FakePublisher* const second_ = new hal::FakePublisher;
    TeePublisher sut_{std::unique_ptr<hal::Publisher>(first_),
                      std::unique_ptr<hal::Publisher>(second_)};
};

TEST_F(TeePublisherTest, BothGetEverything) {
    EXPECT_TRUE(sut_.Publish(hal::PanoramaImage{.sequence = 4}));
    EXPECT_TRUE(sut_.Publish(hal::PanoramaStatus{.sequence = 4}));
    EXPECT_TRUE(sut_.Publish(hal::HitchAngle{}));
    EXPECT_TRUE(sut_.Publish(hal::Event{.code = hal::EventCode::kCameraBack}));
    EXPECT_TRUE(sut_.Publish(hal::Health{}));
    EXPECT_TRUE(sut_.Publish(hal::ViewportImage{}));
    EXPECT_TRUE(sut_.Publish(hal::PreviewImage{}));
    EXPECT_TRUE(sut_.Publish(hal::Overlay{}));
    for (const hal::FakePublisher* const receiver : {first_, second_}) {
        EXPECT_EQ(receiver->images.size(), 1U);
        EXPECT_EQ(receiver->statuses.size(), 1U);
        EXPECT_EQ(receiver->angles.size(), 1U);
        EXPECT_EQ(receiver->events.size(), 1U);
        EXPECT_EQ(receiver->healths.size(), 1U);
        EXPECT_EQ(receiver->viewports, 1);
        EXPECT_EQ(receiver->previews, 1);
        EXPECT_EQ(receiver->overlays, 1);
    }
}

TEST_F(TeePublisherTest, WhatTheFirstRefusesTheSecondGetsAllTheSame) {
    first_->refusal = hal::Error::kTooLarge;
    const auto published = sut_.Publish(hal::PanoramaImage{.sequence = 4});
    ASSERT_FALSE(published);
    EXPECT_EQ(published.error(), hal::Error::kTooLarge);
    EXPECT_EQ(second_->images.size(), 1U);
}

TEST_F(TeePublisherTest, WhatTheSecondRefusesIsTold) {
    second_->refusal = hal::Error::kFailed;
    const auto published = sut_.Publish(hal::PanoramaStatus{});
    ASSERT_FALSE(published);
    EXPECT_EQ(published.error(), hal::Error::kFailed);
    EXPECT_EQ(first_->statuses.size(), 1U);
}

}  // namespace
}  // namespace hitchview::app
