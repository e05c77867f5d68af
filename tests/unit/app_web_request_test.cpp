#include <gtest/gtest.h>

#include "app/web_budget.hpp"
#include "app/web_listen.hpp"
#include "app/web_request.hpp"

namespace hitchview::app {
namespace {

using std::chrono::milliseconds;

TEST(WebRequestTest, APathNamesItsRouteAndEverythingElseIsAFileOfThePage) {
    EXPECT_EQ(TargetOf("/events").route, WebRoute::kEvents);
    EXPECT_EQ(TargetOf("/panorama.jpg").route, WebRoute::kPanorama);
    EXPECT_EQ(TargetOf("/previews").route, WebRoute::kPreviews);
    EXPECT_EQ(TargetOf("/overlay").route, WebRoute::kOverlay);
    EXPECT_EQ(TargetOf("/recordings").route, WebRoute::kRecordings);
    EXPECT_EQ(TargetOf("/recordings/a.lcm").route, WebRoute::kRecordingFile);
    EXPECT_EQ(TargetOf("/recordings/a.lcm").name, "a.lcm");
    EXPECT_EQ(TargetOf("/").name, "index.html");
    EXPECT_EQ(TargetOf("/page.css").name, "page.css");
    EXPECT_EQ(TargetOf("/events/").route, WebRoute::kPageFile);
}

TEST(WebRequestTest, OnlyAddressesAndLocalhostAreOurName) {
    for (const char* host : {"127.0.0.1", "127.0.0.1:8080", "localhost:1", "localhost", "[::1]",
                             "[::1]:8080", "192.168.7.2:80"}) {
        EXPECT_TRUE(IsOwnHost(host)) << host;
    }
    for (const char* host : {"", "example.com", "example.com:8080", "127.0.0.1.example.com",
                             "localhost.example.com", "127.0.0.1:", "127.0.0.1:99999", "[::1",
                             "[::1]x", "[example]", "::1", "127.0.0.1:80:80", "user@127.0.0.1"}) {
        EXPECT_FALSE(IsOwnHost(host)) << host;
    }
}

TEST(WebRequestTest, ASerialThatIsNoNumberCountsAsNone) {
    EXPECT_EQ(SerialOf("17"), 17U);
    EXPECT_EQ(SerialOf("18446744073709551615"), UINT64_MAX);
    for (const char* text : {"", "-1", "1x", " 1", "18446744073709551616", "0x10"}) {
        EXPECT_EQ(SerialOf(text), 0U) << text;
    }
}

TEST(WebRequestTest, ARangeIsCutToTheFile) {
    const auto part = [](const char* header) {
        const WebRangeAnswer answer = AnswerRange(header, 1000);
        EXPECT_EQ(answer.kind, WebRangeKind::kPart) << header;
        return std::pair(answer.range.first, answer.range.count);
    };
    using Part = std::pair<std::uint64_t, std::uint64_t>;
    EXPECT_EQ(part("bytes=0-0"), Part(0, 1));
    EXPECT_EQ(part("bytes=200-"), Part(200, 800));
    EXPECT_EQ(part("bytes=200-99999"), Part(200, 800));
    EXPECT_EQ(part("bytes=-300"), Part(700, 300));
    EXPECT_EQ(part("bytes=-5000"), Part(0, 1000));
    EXPECT_EQ(part("bytes=0-18446744073709551615"), Part(0, 1000));
}

TEST(WebRequestTest, ARangeBehindTheFileIsSaidToBeOutside) {
    EXPECT_EQ(AnswerRange("bytes=1000-", 1000).kind, WebRangeKind::kOutside);
    EXPECT_EQ(AnswerRange("bytes=-0", 1000).kind, WebRangeKind::kOutside);
    EXPECT_EQ(AnswerRange("bytes=0-", 0).kind, WebRangeKind::kOutside);
    EXPECT_EQ(AnswerRange("bytes=-5", 0).kind, WebRangeKind::kOutside);
}

TEST(WebRequestTest, WhatIsNoSingleRangeIsAnsweredByTheWholeFile) {
    for (const char* header :
         {"", "bytes", "bytes=", "bytes=-", "bytes=5-2", "bytes=0-1,5-6", "bytes=a-b", "items=0-5",
          "bytes=0x1-2", "bytes=--5", "bytes=18446744073709551616-"}) {
        EXPECT_EQ(AnswerRange(header, 1000).kind, WebRangeKind::kWhole) << header;
    }
}

TEST(WebRequestTest, ARecordingsNameLeadsNowhereElse) {
    for (const char* name : {"20261122t201500Z-0001.lcm", "a.lcm", "A_b-c+d.1.lcm"}) {
        EXPECT_TRUE(IsRecordingName(name)) << name;
    }
    const std::string long_name(200, 'a');
    for (const std::string& name :
         {std::string(), std::string(".lcm"), std::string("..lcm"), std::string("../a.lcm"),
          std::string("a/b.lcm"), std::string("a\\b.lcm"), std::string("a.txt"),
          std::string("a.lcm\0", 6), std::string("a b.lcm"), long_name + ".lcm"}) {
        EXPECT_FALSE(IsRecordingName(name)) << name;
    }
}

TEST(WebBudgetTest, OverALongTimeNoMoreGoesOutThanTheBudget) {
    WebBudget budget(1e6);
    std::size_t sent_bytes = 0;
    for (milliseconds now{0}; now <= milliseconds(10'000); now += milliseconds(10)) {
        while (budget.Take(30'000, now)) sent_bytes += 30'000;
    }
    EXPECT_NEAR(double(sent_bytes), 10e6, 0.2e6);
}

TEST(WebBudgetTest, OnePictureLargerThanTheBudgetGoesOutAndIsPaidForAfterwards) {
    WebBudget budget(1000);
    EXPECT_TRUE(budget.Take(5000, milliseconds(0)));
    EXPECT_FALSE(budget.Take(1, milliseconds(4800)));
    EXPECT_TRUE(budget.Take(1, milliseconds(5000)));
}

TEST(WebListenTest, APortThatIsTakenAndAnAddressThatIsNoneAreSaid) {
    const auto first = Listen("127.0.0.1", 0);
    ASSERT_TRUE(first) << first.error();
    EXPECT_GT(first.value().port, 0);
    const auto second = Listen("127.0.0.1", first.value().port);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().find("--port 0"), std::string::npos) << second.error();
    EXPECT_FALSE(Listen("example.com", 0));
}

}  // namespace
}  // namespace hitchview::app
