#include <gtest/gtest.h>

#include <limits>

#include "hal/fixed_text.hpp"

namespace hitchview::hal {
namespace {

TEST(FixedTextTest, IsPutTogetherOfWordsAndNumbers) {
    const auto text = FixedText<32>("back after ").AppendNumber(-412).Append(" ms");
    EXPECT_EQ(text.view(), "back after -412 ms");
    EXPECT_STREQ(text.c_str(), "back after -412 ms");
    EXPECT_STREQ(FixedText<4>().c_str(), "");
}

TEST(FixedTextTest, WhatIsTooLongIsCut) {
    FixedText<6> text("1234");
    EXPECT_EQ(text.Append("5678").view(), "12345");
    EXPECT_STREQ(text.Append("9").c_str(), "12345");
    EXPECT_EQ(FixedText<1>("x").view(), "");
}

TEST(FixedTextTest, EveryNumberFits) {
    constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
    EXPECT_EQ(FixedText<32>().AppendNumber(kLeast).view(), "-9223372036854775808");
}

}  // namespace
}  // namespace hitchview::hal
