#include <gtest/gtest.h>

#include "drivers/lcm_camera_names.hpp"
#include "tests/support/health_message.hpp"
#include "tests/support/image_message.hpp"

namespace hitchview::drivers {
namespace {

using Names = std::vector<std::string>;
using Bytes = std::vector<std::uint8_t>;
using tests::HealthMessage;

/// Parsed from memory of exactly its size, so that a sanitizer sees a read past the end.
hal::Result<Names> Parse(const Bytes& message) {
    const Bytes exact(message.begin(), message.end());
    return ParseCameraNames(exact);
}

/// Where the count of cameras stands: behind texts of 6, 1 and 5 bytes.
constexpr std::size_t kCountAt = 8 + 20 + (4 + 6) + (4 + 1) + 64 + (4 + 5) + 32 + 25;

TEST(LcmCameraNamesTest, AreThoseOfASoundMessageInTheirOrder) {
    const Names names{"front", "left", "rear"};
    const auto parsed = Parse(HealthMessage(names));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed.value(), names);
    EXPECT_TRUE(Parse(HealthMessage({})).value().empty());
}

TEST(LcmCameraNamesTest, AMessageThatIsCutAnywhereIsRefused) {
    const Bytes sound = HealthMessage({"front", "left"});
    for (std::size_t bytes = 0; bytes < sound.size(); ++bytes) {
        const auto cut = sound.begin() + static_cast<std::ptrdiff_t>(bytes);
        EXPECT_FALSE(Parse(Bytes(sound.begin(), cut))) << bytes;
    }
}

TEST(LcmCameraNamesTest, BytesLeftOverAndOtherTypesAreRefused) {
    Bytes longer = HealthMessage({"front"});
    longer.push_back(0);
    EXPECT_FALSE(Parse(longer));
    Bytes other = HealthMessage({"front"});
    other[0] ^= 1;
    EXPECT_FALSE(Parse(other));
}

TEST(LcmCameraNamesTest, CountsThatCannotBeAreRefusedWithoutMemoryForThem) {
    for (const std::int32_t count : {-1, INT32_MIN, INT32_MAX, 9, 2, 0}) {
        Bytes message = HealthMessage({"front"});
        tests::PutInt32(message, kCountAt, count);
        EXPECT_FALSE(Parse(message)) << count;
    }
    Bytes same = HealthMessage({"front"});
    tests::PutInt32(same, kCountAt, 1);
    EXPECT_TRUE(Parse(same)) << "the count stands elsewhere";
}

TEST(LcmCameraNamesTest, NamesThatNoScreenShouldShowAreRefused) {
    EXPECT_FALSE(Parse(HealthMessage({"fr\nont"})));
    EXPECT_FALSE(Parse(HealthMessage({"fr\x1b[2Jont"})));
}

}  // namespace
}  // namespace hitchview::drivers
