#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "drivers/lcm_subscriber.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/datagram_listener.hpp"
#include "tests/support/small_drive.hpp"

// `hitchview run` as a service, with the test in place of the service manager. Runs in a network
// namespace of its own (tests/support/lcm_namespace.sh).
namespace hitchview {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using tests::ChildProcess;

constexpr milliseconds kLongestStart{60'000};
constexpr int kFrames = 1800;  // a minute, longer than any test here

class ServiceRunTest : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<tests::TemporaryFolder>();
        tests::RecordSmallDrive(*folder_, 16, kFrames);
    }
    static void TearDownTestSuite() { folder_.reset(); }

    ServiceRunTest() {
        auto subscriber = drivers::LcmSubscriber::Create({});
        EXPECT_TRUE(subscriber) << subscriber.error();
        panoramas_ = std::move(*subscriber);
    }

    /// `frames`: after which it ends by itself.
    [[nodiscard]] std::unique_ptr<ChildProcess> Run(int frames) const {
        const std::string rig =
            tests::SmallDriveRig(*folder_, "{projection: cylinder, size_px: [1024, 180]}", "");
        return std::make_unique<ChildProcess>(
            HITCHVIEW,
            std::vector<std::string>{"run", "--rig", rig, "--out", *folder_ / "out", "--frames",
                                     std::to_string(frames)},
            std::vector<std::string>{"NOTIFY_SOCKET=" + Address()});
    }

    /// All that the manager is told up to and with `last`; without it when it does not come.
    std::vector<std::string> TakeUntil(const std::string& last, milliseconds longest) {
        std::vector<std::string> told;
        const auto end = steady_clock::now() + longest;
        while (steady_clock::now() < end && (told.empty() || told.back() != last)) {
            if (auto next = manager_.Take(milliseconds(20))) told.push_back(std::move(*next));
        }
        return told;
    }

    bool TakePanorama(milliseconds longest) {
        const auto end = steady_clock::now() + longest;
        while (steady_clock::now() < end)
            if (panoramas_->WaitImage(milliseconds(20))) return true;
        return false;
    }

    static std::string Address() { return *folder_ / "notify"; }
    static std::unique_ptr<tests::TemporaryFolder> folder_;
    tests::DatagramListener manager_{Address()};
    std::unique_ptr<drivers::LcmSubscriber> panoramas_;

 private:
    struct RemoveSocket {
        ~RemoveSocket() { std::filesystem::remove(Address()); }
    } remove_socket_;
};

std::unique_ptr<tests::TemporaryFolder> ServiceRunTest::folder_;

TEST_F(ServiceRunTest, ItIsReadyWhenAPanoramaHasComeAndFedWhilePanoramasCome) {
    const auto program = Run(kFrames);
    const auto before = TakeUntil("READY=1", kLongestStart);
    program->Signal(SIGSTOP);
    ASSERT_THAT(before, Contains("READY=1"));
    EXPECT_THAT(before, Not(Contains("WATCHDOG=1")));
    EXPECT_TRUE(TakePanorama(seconds(2)));

    TakeUntil("", seconds(1));  // what was under way
    EXPECT_FALSE(manager_.Take(seconds(1))) << "fed by a program that stands still";

    program->Signal(SIGCONT);
    EXPECT_THAT(TakeUntil("WATCHDOG=1", kLongestStart), Contains("WATCHDOG=1"));
    EXPECT_TRUE(TakePanorama(seconds(10)));

    program->Signal(SIGTERM);
    const auto until_end = TakeUntil("STOPPING=1", kLongestStart);
    ASSERT_THAT(until_end, Contains("STOPPING=1"));
    EXPECT_THAT(until_end, Not(Contains("READY=1")));
    EXPECT_EQ(program->Wait(), 0);
    EXPECT_TRUE(manager_.TakeAll().empty()) << "nothing follows STOPPING=1";
}

TEST_F(ServiceRunTest, WhatTheNetworkDoesNotTakeFeedsNobody) {
    const auto program = Run(kFrames);
    ASSERT_THAT(TakeUntil("WATCHDOG=1", kLongestStart), Contains("WATCHDOG=1"));
    ASSERT_EQ(std::system("ip route del 224.0.0.0/4 dev lo"), 0);
    TakeUntil("", seconds(1));
    EXPECT_THAT(TakeUntil("", seconds(2)), Each(StartsWith("STATUS=")));
    ASSERT_EQ(std::system("ip route add 224.0.0.0/4 dev lo"), 0);
    EXPECT_THAT(TakeUntil("WATCHDOG=1", kLongestStart), Contains("WATCHDOG=1"));
    program->Signal(SIGTERM);
    TakeUntil("STOPPING=1", kLongestStart);
    EXPECT_EQ(program->Wait(), 0);
}

TEST_F(ServiceRunTest, ItIsFedOnceForEachPanoramaThatWasSent) {
    constexpr int kShort = 90;
    const auto program = Run(kShort);
    const auto told = TakeUntil("STOPPING=1", kLongestStart);
    EXPECT_EQ(program->Wait(), 0);
    const auto report = nlohmann::json::parse(tests::FileText(*folder_ / "out/report.json"));
    const int sent = kShort - report.at("dropped").get<int>();
    const auto feeds = std::ranges::count(told, "WATCHDOG=1");
    EXPECT_EQ(std::ranges::count(told, "READY=1"), 1);
    EXPECT_LE(feeds, sent);
    EXPECT_GT(feeds, sent / 2);  // the socket holds ten that a busy machine does not read in time
    EXPECT_THAT(told, Contains(StartsWith("STATUS=")));
}

TEST_F(ServiceRunTest, WithoutAnyCameraItEndsAndSaysWhy) {
    const std::string rig =
        folder_->Write("absent.yaml",
                       "schema: 1\ncanvas: {projection: plane, size_px: [640, 300]}\nunits:\n"
                       "  tractor: {cameras: [{name: a, source: {v4l2: /dev/absent-a}}]}\n"
                       "  trailer: {cameras: [{name: b, source: {v4l2: /dev/absent-b}}]}\n");
    std::FILE* const output = popen((HITCHVIEW " run --rig " + rig + " 2>&1").c_str(), "r");
    std::string text;
    for (int letter = std::fgetc(output); letter != EOF; letter = std::fgetc(output))
        text += static_cast<char>(letter);
    EXPECT_EQ(WEXITSTATUS(pclose(output)), 3);
    EXPECT_THAT(text, HasSubstr("camera a: /dev/absent-a: open: No such file or directory\n"));
}

TEST_F(ServiceRunTest, AnAddressThatIsNoneIsRefusedAtTheStart) {
    const std::string rig =
        tests::SmallDriveRig(*folder_, "{projection: cylinder, size_px: [1024, 180]}", "");
    ChildProcess program(HITCHVIEW, {"run", "--rig", rig}, {"NOTIFY_SOCKET=nowhere"});
    EXPECT_NE(program.Wait(), 0);
}

}  // namespace
}  // namespace hitchview
