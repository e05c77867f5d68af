#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/lcm_url.hpp"

namespace hitchview::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(LcmUrlTest, UrlsThatLcmTakesAreSound) {
    for (const char* url :
         {kDefaultLcmUrl, "udpm://224.0.0.0:1", "udpm://239.255.76.67:65535?ttl=255",
          "mpudpm://239.255.76.67:7667?ttl=1&recv_buf_size=8388608&transmit_only=true",
          "file:///tmp/a.lcmlog?mode=w", "memq://", "tcpq://10.0.0.1:7700"}) {
        EXPECT_TRUE(CheckLcmUrl(url)) << url;
    }
}

TEST(LcmUrlTest, AMistakeIsNamedWithItsRange) {
    const struct {
        const char* url;
        const char* says;
    } cases[] = {
        {"", "scheme is ''"},
        {"http://239.255.76.67:7667", "scheme is 'http', must be udpm"},
        {"udpm:/239.255.76.67:7667", "scheme"},
        {"udpm://192.168.1.1:7667", "address is '192.168.1.1', must be 224.0.0.0 to"},
        {"udpm://239.255.76:7667", "address"},
        {"udpm://239.255.76.256:7667", "address"},
        {"udpm://239.255.76.67", "port is '', must be 1 to 65535"},
        {"udpm://239.255.76.67:0", "port is '0'"},
        {"udpm://239.255.76.67:70000", "port is '70000'"},
        {"udpm://239.255.76.67:7667?ttl=256", "ttl is '256', must be 0 to 255"},
        {"udpm://239.255.76.67:7667?ttl=", "ttl is ''"},
        {"udpm://239.255.76.67:7667?tll=1", "option 'tll'"},
        {"udpm://239.255.76.67:7667?recv_buf_size=1", "recv_buf_size is '1', must be 4096"},
    };
    for (const auto& c : cases) {
        const auto result = CheckLcmUrl(c.url);
        ASSERT_FALSE(result) << c.url;
        EXPECT_THAT(result.error(), HasSubstr(c.says));
        EXPECT_THAT(result.error(), HasSubstr(c.url));
    }
}

TEST(LcmUrlTest, AChannelThatWouldBeAPatternIsRefused) {
    EXPECT_TRUE(CheckLcmChannel("channel", "PANORAMA_2"));
    EXPECT_TRUE(CheckLcmChannel("channel", std::string(63, 'A')));
    for (const std::string& name : {std::string(), std::string(".*"), std::string(64, 'A')}) {
        const auto result = CheckLcmChannel("panorama_channel", name);
        ASSERT_FALSE(result) << name;
        EXPECT_THAT(result.error(), AllOf(HasSubstr("panorama_channel is '"), HasSubstr(name)));
    }
}

TEST(LcmUrlTest, TheReceiveBufferIsAddedOnceAndOnlyToMulticast) {
    EXPECT_EQ(WithReceiveBuffer("udpm://239.255.76.67:7667", 4096),
              "udpm://239.255.76.67:7667?recv_buf_size=4096");
    EXPECT_EQ(WithReceiveBuffer("mpudpm://239.255.76.67:7667?ttl=1", 4096),
              "mpudpm://239.255.76.67:7667?ttl=1&recv_buf_size=4096");
    EXPECT_EQ(WithReceiveBuffer("udpm://239.255.76.67:7667?recv_buf_size=8192", 4096),
              "udpm://239.255.76.67:7667?recv_buf_size=8192");
    EXPECT_EQ(WithReceiveBuffer("file:///tmp/a.lcmlog", 4096), "file:///tmp/a.lcmlog");
}

}  // namespace
}  // namespace hitchview::drivers
