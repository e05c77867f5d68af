#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>

#include <cstring>
#include <random>
#include <vector>

#include "drivers/socketcan_link.hpp"

namespace hitchview::drivers {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

template <typename T>
Bytes BytesOf(const T& value) {
    Bytes bytes(sizeof value);
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

Bytes BytesOf(const std::string& text) {
    Bytes bytes(text.size() + 1);
    std::memcpy(bytes.data(), text.c_str(), bytes.size());
    return bytes;
}

void Append(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    bytes.resize((bytes.size() + 3) / 4 * 4);
}

Bytes Attribute(int type, const Bytes& content) {
    Bytes bytes =
        BytesOf(rtattr{.rta_len = static_cast<unsigned short>(sizeof(rtattr) + content.size()),
                       .rta_type = static_cast<unsigned short>(type)});
    Append(bytes, content);
    return bytes;
}

/// A message as the kernel's, of an interface whose driver says `info` of it.
Bytes Message(unsigned short type, unsigned flags, const Bytes& info) {
    ifinfomsg link{};
    link.ifi_type = type;
    link.ifi_flags = flags;
    Bytes message = BytesOf(nlmsghdr{.nlmsg_len = 0,
                                     .nlmsg_type = RTM_NEWLINK,
                                     .nlmsg_flags = 0,
                                     .nlmsg_seq = 0,
                                     .nlmsg_pid = 0});
    Append(message, BytesOf(link));
    Append(message, Attribute(IFLA_IFNAME, BytesOf(std::string("can0"))));
    Append(message, Attribute(IFLA_LINKINFO | NLA_F_NESTED, info));
    const auto length = static_cast<std::uint32_t>(message.size());
    std::memcpy(message.data(), &length, sizeof length);
    return message;
}

Bytes Info(const std::string& kind, const Bytes& data) {
    Bytes info = Attribute(IFLA_INFO_KIND, BytesOf(kind));
    Append(info, Attribute(IFLA_INFO_DATA, data));
    return info;
}

Bytes Controller(std::uint32_t bit_rate, std::uint32_t state) {
    can_bittiming timing{};
    timing.bitrate = bit_rate;
    Bytes data;
    if (bit_rate > 0) Append(data, Attribute(IFLA_CAN_BITTIMING, BytesOf(timing)));
    Append(data, Attribute(IFLA_CAN_STATE, BytesOf(state)));
    Append(data, Attribute(IFLA_CAN_RESTART_MS, BytesOf(std::uint32_t{100})));
    return data;
}

TEST(SocketCanLinkTest, AControllerTellsItsBitRateAndState) {
    using State = CanLink::State;
    for (const auto& [number, state] : {std::pair{CAN_STATE_ERROR_ACTIVE, State::kActive},
                                        {CAN_STATE_ERROR_WARNING, State::kWarning},
                                        {CAN_STATE_ERROR_PASSIVE, State::kPassive},
                                        {CAN_STATE_BUS_OFF, State::kBusOff},
                                        {CAN_STATE_STOPPED, State::kStopped},
                                        {CAN_STATE_SLEEPING, State::kSleeping}}) {
        const auto link =
            ParseCanLink(Message(ARPHRD_CAN, IFF_UP, Info("can", Controller(500'000, number))));
        ASSERT_TRUE(link);
        EXPECT_TRUE(link->is_can);
        EXPECT_TRUE(link->is_up);
        EXPECT_EQ(link->kind, "can");
        EXPECT_EQ(link->bit_rate, 500'000U);
        EXPECT_EQ(link->state, state);
        EXPECT_EQ(link->restart_ms, 100U);
    }
}

TEST(SocketCanLinkTest, WithoutBitRateItIsZero) {
    const auto link =
        ParseCanLink(Message(ARPHRD_CAN, 0, Info("can", Controller(0, CAN_STATE_STOPPED))));
    ASSERT_TRUE(link);
    EXPECT_FALSE(link->is_up);
    EXPECT_EQ(link->bit_rate, 0U);
}

TEST(SocketCanLinkTest, WhatAVirtualBusOrAnotherInterfaceSaysIsNotTakenForAController) {
    const auto bus = ParseCanLink(
        Message(ARPHRD_CAN, IFF_UP, Info("vcan", Controller(500'000, CAN_STATE_BUS_OFF))));
    ASSERT_TRUE(bus);
    EXPECT_EQ(bus->kind, "vcan");
    EXPECT_FALSE(bus->state);
    const auto other = ParseCanLink(
        Message(ARPHRD_ETHER, IFF_UP, Info("can", Controller(500'000, CAN_STATE_BUS_OFF))));
    ASSERT_TRUE(other);
    EXPECT_FALSE(other->is_can);
    EXPECT_EQ(other->bit_rate, 0U);
}

TEST(SocketCanLinkTest, CutOffOrDamagedMessagesAreSurvived) {
    const Bytes whole =
        Message(ARPHRD_CAN, IFF_UP, Info("can", Controller(500'000, CAN_STATE_ERROR_ACTIVE)));
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
        // Of its own memory, so that a sanitizer sees what is read beyond its end.
        const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));
        EXPECT_EQ(ParseCanLink(part).has_value(), bytes >= sizeof(nlmsghdr) + sizeof(ifinfomsg));
    }
    std::mt19937 random(7);
    for (int i = 0; i < 20'000; ++i) {
        Bytes damaged = whole;
        damaged[random() % damaged.size()] = static_cast<std::byte>(random());
        static_cast<void>(ParseCanLink(damaged));
    }
}

TEST(SocketCanLinkTest, ThisMachinesLoopbackIsUpOrDownAndNoBus) {
    const auto link = ReadCanLink("lo");
    ASSERT_TRUE(link) << link.error();
    EXPECT_FALSE(link.value().is_can);
    const auto none = ReadCanLink("nothing0");
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error(), HasSubstr("there is no interface 'nothing0'"));
}

}  // namespace
}  // namespace hitchview::drivers
