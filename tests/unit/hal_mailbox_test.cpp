#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "hal/mailbox.hpp"

namespace hitchview::hal {
namespace {

TEST(MailboxTest, IsEmptyUntilSomethingIsPublished) {
    Mailbox<int> mailbox;
    EXPECT_FALSE(mailbox.Take());
}

TEST(MailboxTest, TheNewestWins) {
    Mailbox<int> mailbox;
    for (const int value : {1, 2, 3}) {
        mailbox.writable() = value;
        mailbox.Publish();
    }
    ASSERT_TRUE(mailbox.Take());
    EXPECT_EQ(mailbox.readable(), 3);
    EXPECT_FALSE(mailbox.Take());
}

TEST(MailboxTest, WhatWasTakenStaysWhileTheWriterGoesOn) {
    Mailbox<int> mailbox;
    mailbox.writable() = 1;
    mailbox.Publish();
    ASSERT_TRUE(mailbox.Take());
    for (int value = 2; value < 9; ++value) {
        mailbox.writable() = value;
        mailbox.Publish();
        EXPECT_EQ(mailbox.readable(), 1);
    }
    ASSERT_TRUE(mailbox.Take());
    EXPECT_EQ(mailbox.readable(), 8);
}

TEST(MailboxTest, TwoThreadsSeeWholeItemsThatOnlyGrow) {
    constexpr int kItems = 50'000;
    Mailbox<std::array<int, 8>> mailbox;
    std::thread writer([&] {
        for (int i = 1; i <= kItems; ++i) {
            mailbox.writable().fill(i);
            mailbox.Publish();
        }
    });
    int last = 0;
    int broken = 0;
    while (last < kItems) {
        if (!mailbox.Take()) continue;
        const std::array<int, 8>& item = mailbox.readable();
        for (const int part : item) broken += part != item.front() ? 1 : 0;
        broken += item.front() <= last ? 1 : 0;
        last = item.front();
    }
    writer.join();
    EXPECT_EQ(broken, 0);
    EXPECT_FALSE(mailbox.Take());
}

}  // namespace
}  // namespace hitchview::hal
