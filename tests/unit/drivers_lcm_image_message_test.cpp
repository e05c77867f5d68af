#include <gtest/gtest.h>

#include <random>

#include "drivers/lcm_image_message.hpp"
#include "tests/support/image_message.hpp"

namespace hitchview::drivers {
namespace {

using hal::Error;
using tests::ImageMessage;
using tests::PutInt32;
using Bytes = std::vector<std::uint8_t>;

/// Parsed from memory of exactly its size, so that a sanitizer sees a read past the end.
hal::Result<hal::PanoramaImage> Parse(const Bytes& message) {
    static Bytes exact;
    exact = Bytes(message.begin(), message.end());
    return ParseImageMessage(exact);
}

testing::AssertionResult IsCorrupted(const Bytes& message) {
    const auto result = Parse(message);
    if (result) return testing::AssertionFailure() << "taken as sound";
    return result.error() == Error::kCorrupted
               ? testing::AssertionSuccess()
               : testing::AssertionFailure() << ToString(result.error());
}

TEST(LcmImageMessageTest, ASoundMessageGivesWhatWasPutIn) {
    const auto result = Parse(ImageMessage{}.Encode());

    ASSERT_TRUE(result);
    const hal::PanoramaImage& image = result.value();
    EXPECT_EQ(image.sequence, 7U);
    EXPECT_EQ(image.captured_from.count(), 1000);
    EXPECT_EQ(image.captured_until.count(), 2000);
    EXPECT_EQ(image.width_px, 64);
    EXPECT_EQ(image.height_px, 32);
    EXPECT_EQ(image.cameras_missing, 5U);
    EXPECT_EQ(image.calibration_id, "abc");
    EXPECT_EQ(Bytes(image.jpeg.begin(), image.jpeg.end()), ImageMessage{}.data);
}

TEST(LcmImageMessageTest, APropertyThatIsNotKnownIsSkipped) {
    ImageMessage message;
    message.properties.emplace_back("colour", "red");
    EXPECT_TRUE(Parse(message.Encode()));
}

TEST(LcmImageMessageTest, EveryTruncationIsCorrupted) {
    const Bytes whole = ImageMessage{}.Encode();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_TRUE(IsCorrupted(Bytes(whole.begin(), whole.begin() + static_cast<int>(size))))
            << size;
    }
}

TEST(LcmImageMessageTest, BytesLeftOverAreCorrupted) {
    Bytes message = ImageMessage{}.Encode();
    message.push_back(0);
    EXPECT_TRUE(IsCorrupted(message));
}

TEST(LcmImageMessageTest, AnotherTypeIsCorrupted) {
    EXPECT_TRUE(IsCorrupted(ImageMessage{.fingerprint = 0x14739ffe13d5f5f1}.Encode()));
}

TEST(LcmImageMessageTest, FieldsOutOfRangeAreCorrupted) {
    const Bytes sound = ImageMessage{}.Encode();
    const struct {
        std::size_t at;
        std::vector<std::int32_t> values;
    } fields[] = {
        {ImageMessage::kWidthAt, {0, -1, 16385, INT32_MAX, INT32_MIN}},
        {ImageMessage::kHeightAt, {0, -1, 16385, INT32_MAX, INT32_MIN}},
        {ImageMessage::kRowStrideAt, {-1, INT32_MIN}},
        {ImageMessage::kPixelFormatAt, {0, 859981650}},
        {ImageMessage::kSizeAt, {0, -1, 3, 5, 1 << 30, INT32_MAX, INT32_MIN}},
        {ImageMessage{}.PropertyCountAt(), {0, -1, 4, 6, 1 << 30, INT32_MAX, INT32_MIN}},
        {ImageMessage{}.PropertyCountAt() + 4, {0, -1, 8, 10, 1 << 30, INT32_MAX, INT32_MIN}},
        {ImageMessage{}.PropertyCountAt() + 4 + 4 + 9, {0, -1, 2, 1 << 30, INT32_MAX, INT32_MIN}},
    };
    for (const auto& field : fields) {
        for (const std::int32_t value : field.values) {
            Bytes message = sound;
            PutInt32(message, field.at, value);
            EXPECT_TRUE(IsCorrupted(message)) << "at " << field.at << ": " << value;
        }
    }
}

TEST(LcmImageMessageTest, APropertyMissingTwiceOrNotANumberIsCorrupted) {
    for (std::size_t i = 0; i < ImageMessage{}.properties.size(); ++i) {
        ImageMessage missing;
        missing.properties.erase(missing.properties.begin() + static_cast<int>(i));
        EXPECT_TRUE(IsCorrupted(missing.Encode())) << i;

        ImageMessage twice;
        twice.properties.push_back(twice.properties.at(i));
        EXPECT_TRUE(IsCorrupted(twice.Encode())) << i;
    }
    for (const char* text : {"", "-1", "4294967296", "7 ", "seven"}) {
        ImageMessage message;
        message.properties.front().second = text;
        EXPECT_TRUE(IsCorrupted(message.Encode())) << text;
    }
}

TEST(LcmImageMessageTest, NoDamageReachesMemoryItMayNot) {
    const Bytes sound = ImageMessage{}.Encode();
    std::mt19937 random(20);
    for (int round = 0; round < 20000; ++round) {
        Bytes message = sound;
        for (int hits = 1 + static_cast<int>(random() % 4); hits > 0; --hits) {
            message.at(random() % message.size()) = static_cast<std::uint8_t>(random());
        }
        const auto result = Parse(message);
        if (!result) continue;
        EXPECT_LE(result.value().jpeg.size(), message.size());
        EXPECT_GE(result.value().width_px, 1);
    }
}

}  // namespace
}  // namespace hitchview::drivers
