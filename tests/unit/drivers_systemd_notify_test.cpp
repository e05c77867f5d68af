#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/systemd_notify.hpp"
#include "tests/support/datagram_listener.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::drivers {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::DatagramListener;

std::unique_ptr<hal::Watchdog> Open(const std::string& address) {
    auto opened = SystemdNotify::Open(address.c_str());
    EXPECT_TRUE(opened) << opened.error();
    return std::move(opened.value());
}

/// Both kinds of address that systemd gives a service.
class SystemdNotifyTest : public testing::TestWithParam<bool> {
 protected:
    [[nodiscard]] std::string Address() const {
        const std::string path = folder_ / "notify";
        return GetParam() ? path : "@" + path;
    }

    tests::TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Addresses, SystemdNotifyTest, testing::Bool(),
                         [](const auto& is_path) { return is_path.param ? "path" : "abstract"; });

TEST_P(SystemdNotifyTest, TellsTheManagerWhatHappens) {
    DatagramListener manager(Address());
    const auto watchdog = Open(Address());
    watchdog->Ready();
    watchdog->Feed();
    watchdog->Feed();
    watchdog->Stop();
    EXPECT_THAT(manager.TakeAll(),
                ElementsAre("READY=1", "WATCHDOG=1", "WATCHDOG=1", "STOPPING=1"));
}

TEST_P(SystemdNotifyTest, AManagerThatComesLaterIsToldThatItIsReady) {
    const auto watchdog = Open(Address());
    watchdog->Ready();
    watchdog->Feed();
    DatagramListener manager(Address());
    watchdog->Feed();
    watchdog->Feed();
    EXPECT_THAT(manager.TakeAll(), ElementsAre("READY=1", "WATCHDOG=1", "WATCHDOG=1"));
}

TEST_P(SystemdNotifyTest, AManagerThatIsTooSlowIsNotWaitedFor) {
    DatagramListener manager(Address());
    const auto watchdog = Open(Address());
    constexpr int kMoreThanItsQueueHolds = 5000;
    for (int i = 0; i < kMoreThanItsQueueHolds; ++i) watchdog->Feed();
    watchdog->Ready();
    EXPECT_LT(manager.TakeAll().size(), kMoreThanItsQueueHolds);
    watchdog->Feed();
    EXPECT_THAT(manager.TakeAll(), ElementsAre("READY=1", "WATCHDOG=1"));
}

hal::Health HealthOf(double panoramas_per_s, std::initializer_list<const char*> missing) {
    hal::Health health{.panoramas_per_s = panoramas_per_s};
    health.cameras.Add({.name = {"front"}, .shown = true});
    for (const char* name : missing) health.cameras.Add({.name = {name}, .shown = false});
    return health;
}

TEST_P(SystemdNotifyTest, TheStatusNamesRateAndMissingCameras) {
    DatagramListener manager(Address());
    const auto watchdog = Open(Address());
    watchdog->Show(HealthOf(29.96, {}));
    watchdog->Show(HealthOf(30.04, {"rear"}));
    watchdog->Show(HealthOf(0, {"left_rear", "rear"}));
    EXPECT_THAT(manager.TakeAll(),
                ElementsAre("STATUS=30.0 panoramas/s", "STATUS=30.0 panoramas/s; no data from rear",
                            "STATUS=0.0 panoramas/s; no data from left_rear, rear"));
}

TEST_P(SystemdNotifyTest, TakesNoMemoryAfterItWasOpened) {
    if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    DatagramListener manager(Address());
    const auto watchdog = Open(Address());
    const hal::Health health = HealthOf(30, {"left_rear", "rear"});
    const std::uint64_t before = tests::HeapCallsOfThisThread();
    watchdog->Ready();
    watchdog->Feed();
    watchdog->Show(health);
    watchdog->Stop();
    EXPECT_EQ(tests::HeapCallsOfThisThread(), before);
}

TEST(SystemdNotifyAddressTest, WithoutAManagerThereIsNoWatchdog) {
    EXPECT_EQ(SystemdNotify::Open(nullptr).value(), nullptr);
    EXPECT_EQ(SystemdNotify::Open("").value(), nullptr);
}

TEST(SystemdNotifyAddressTest, AnAddressOfAnotherKindIsNamedWithWhatIsAllowed) {
    for (const std::string& address : {std::string("notify"), std::string("/"), std::string("@"),
                                       std::string("vsock:2:1"), "/" + std::string(107, 'a')}) {
        const auto opened = SystemdNotify::Open(address.c_str());
        ASSERT_FALSE(opened) << address;
        EXPECT_THAT(opened.error(), HasSubstr("NOTIFY_SOCKET is " + address + ", must be a path"));
    }
}

TEST(SystemdNotifyAddressTest, TheLongestAddressIsUnderstood) {
    const std::string address = "@" + std::string(106, 'a');
    DatagramListener manager(address);
    Open(address)->Ready();
    EXPECT_THAT(manager.TakeAll(), ElementsAre("READY=1"));
}

}  // namespace
}  // namespace hitchview::drivers
