#include <gtest/gtest.h>

#include <random>

#include "drivers/lcm_handle.hpp"
#include "drivers/lcm_subscriber.hpp"
#include "tests/support/health_message.hpp"
#include "tests/support/image_message.hpp"

// Runs in a network namespace of its own (tests/support/lcm_namespace.sh).
namespace hitchview {
namespace {

using drivers::LcmSubscriber;
using std::chrono::milliseconds;
using tests::ImageMessage;
using tests::PutInt32;
using Bytes = std::vector<std::uint8_t>;

class LcmMalformedTest : public testing::Test {
 protected:
    LcmMalformedTest() : sender_(lcm_create(drivers::kDefaultLcmUrl)) {
        auto subscriber = LcmSubscriber::Create({.max_message_bytes = 300'000});
        EXPECT_TRUE(subscriber) << subscriber.error();
        subscriber_ = std::move(subscriber.value());
    }

    hal::Result<hal::PanoramaImage> SendAndWait(const Bytes& message) {
        EXPECT_EQ(lcm_publish(sender_.get(), "PANORAMA", message.data(),
                              static_cast<unsigned>(message.size())),
                  0);
        return subscriber_->WaitImage(milliseconds(5000));
    }

    void ExpectRefused(const Bytes& message, hal::Error error = hal::Error::kCorrupted) {
        const std::uint64_t before = subscriber_->refused();
        const auto result = SendAndWait(message);
        ASSERT_FALSE(result);
        EXPECT_STREQ(ToString(result.error()), ToString(error));
        EXPECT_EQ(subscriber_->refused(), before + 1);
    }

    void ExpectStillWorking() {
        const std::uint64_t before = subscriber_->received();
        const auto result = SendAndWait(ImageMessage{}.Encode());
        ASSERT_TRUE(result) << ToString(result.error());
        EXPECT_EQ(result.value().sequence, 7U);
        EXPECT_EQ(subscriber_->received(), before + 1);
    }

    drivers::LcmHandle sender_;
    std::unique_ptr<LcmSubscriber> subscriber_;
};

TEST_F(LcmMalformedTest, TruncatedMessagesAreCountedAndRefused) {
    const Bytes sound = ImageMessage{}.Encode();
    for (const std::size_t bytes :
         {std::size_t{0}, std::size_t{7}, std::size_t{40}, sound.size() - 1}) {
        ExpectRefused(Bytes(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(bytes)));
    }
    ExpectStillWorking();
}

TEST_F(LcmMalformedTest, ATruncatedMessageOfManyPacketsIsRefused) {
    ImageMessage message;
    message.data.assign(200'000, 0xAB);
    Bytes bytes = message.Encode();
    bytes.resize(150'000);
    ExpectRefused(bytes);
    ExpectStillWorking();
}

TEST_F(LcmMalformedTest, HugeAndNegativeSizesAreRefused) {
    for (const std::size_t at : {ImageMessage::kSizeAt, ImageMessage{}.PropertyCountAt(),
                                 ImageMessage{}.PropertyCountAt() + 4}) {
        for (const std::int32_t value : {-1, INT32_MIN, INT32_MAX, 1 << 30}) {
            Bytes message = ImageMessage{}.Encode();
            PutInt32(message, at, value);
            ExpectRefused(message);
        }
    }
    ExpectStillWorking();
}

TEST_F(LcmMalformedTest, AnotherTypeAndWrongDimensionsAreRefused) {
    ExpectRefused(ImageMessage{.fingerprint = 1}.Encode());
    ExpectRefused(ImageMessage{.width_px = 0}.Encode());
    ExpectRefused(ImageMessage{.height_px = -360}.Encode());
    ExpectRefused(ImageMessage{.width_px = 2'000'000'000}.Encode());
    ExpectRefused(ImageMessage{.pixel_format = 0}.Encode());
    ExpectStillWorking();
}

TEST_F(LcmMalformedTest, AMessageLargerThanTheMemoryForItIsTooLarge) {
    ImageMessage message;
    message.data.assign(300'000, 0xAB);
    ExpectRefused(message.Encode(), hal::Error::kTooLarge);
    ExpectStillWorking();
}

TEST_F(LcmMalformedTest, RandomBytesAreRefused) {
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        Bytes message(random() % 2000);
        for (auto& byte : message) byte = static_cast<std::uint8_t>(random());
        ExpectRefused(message);
    }
    ExpectStillWorking();
}

TEST_F(LcmMalformedTest, HealthThatIsDamagedIsRefusedAndTheLastNamesStay) {
    const auto send = [this](const Bytes& message) {
        EXPECT_EQ(lcm_publish(sender_.get(), "PANORAMA_HEALTH", message.data(),
                              static_cast<unsigned>(message.size())),
                  0);
        const auto none = subscriber_->WaitImage(milliseconds(5000));
        EXPECT_EQ(none.error(), hal::Error::kTimeout);
    };
    send(tests::HealthMessage({"front", "rear"}));
    EXPECT_EQ(subscriber_->camera_names(), (std::vector<std::string>{"front", "rear"}));
    std::mt19937 random(6);
    const std::uint64_t before = subscriber_->refused();
    for (int i = 0; i < 100; ++i) {
        Bytes message = tests::HealthMessage({"front", "rear"});
        message.resize(random() % message.size());
        send(message);
    }
    EXPECT_EQ(subscriber_->refused(), before + 100);
    EXPECT_EQ(subscriber_->camera_names(), (std::vector<std::string>{"front", "rear"}));
    ExpectStillWorking();
}

}  // namespace
}  // namespace hitchview
