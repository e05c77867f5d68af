#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "app/log_recording.hpp"
#include "app/log_rig.hpp"
#include "app/program.hpp"
#include "app/view_verb.hpp"
#include "drivers/lcm_url.hpp"
#include "tests/support/logged_drive.hpp"
#include "tests/support/shown_panoramas.hpp"

// Recordings beside LCM's own programs. Runs in a network namespace of its own
// (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using std::chrono::milliseconds;
using tests::KeptPanorama;
using tests::RunAndKeep;

constexpr int kFrames = 6;
const std::atomic<bool> kGoOn{false};
const std::string kUrl =
    std::string("--lcm-url=") + drivers::kDefaultLcmUrl + "&recv_buf_size=8388608";

class LcmLogTest : public testing::Test {
 protected:
    void SetUp() override {
        for (const std::string program : {LCM_LOGGER, LCM_LOGPLAYER})
            if (program.ends_with("NOTFOUND")) GTEST_SKIP() << "LCM's programs are not installed";
    }

    static std::size_t EventsIn(const std::string& log) {
        LogRecording recording({log}, kGoOn);
        std::size_t events = 0;
        while (recording.Next()) ++events;
        return events;
    }

    /// Plays `log` with lcm-logplayer, and lcm-logger writes what it hears to the path returned.
    std::string Relogged(const std::string& log) {
        const std::string relogged = folder_ / "relogged.lcm";
        {
            const BackgroundProgram logger(LCM_LOGGER, {"--quiet", "--force", kUrl, relogged});
            for (int i = 0; i < 100 && !std::filesystem::exists(relogged); ++i)
                std::this_thread::sleep_for(milliseconds(50));
            std::this_thread::sleep_for(milliseconds(300));  // it subscribes after it made its file
            EXPECT_EQ(RunProgram(LCM_LOGPLAYER, {kUrl, log}), 0);
            std::this_thread::sleep_for(milliseconds(500));
        }
        EXPECT_EQ(EventsIn(relogged), EventsIn(log));
        return relogged;
    }

    tests::TemporaryFolder folder_;
};

void ExpectSame(const std::vector<KeptPanorama>& a, const std::vector<KeptPanorama>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].sequence, b[i].sequence);
        EXPECT_TRUE(a[i].bytes == b[i].bytes) << "panorama " << i << " differs";
    }
}

TEST_F(LcmLogTest, WhatStockProgramsPlayAndLogAgainIsReplayedAsTheDriveWas) {
    const std::string rig = tests::WriteDriveRig(folder_, kFrames);
    const std::string log = folder_ / "drive.lcm";
    tests::RecordDrive(rig).Write(log);
    const auto replayed = RunAndKeep(LoadLogRig({.logs = {Relogged(log)}}, kGoOn));
    ASSERT_EQ(replayed.size(), kFrames);
    ExpectSame(RunAndKeep(rig), replayed);
}

TEST_F(LcmLogTest, TheStockPlayerFeedsTheDisplay) {
    // What a run published, as a log.
    RigConfig config = LoadRigConfig(tests::WriteDriveRig(folder_, kFrames)).value();
    const std::string log = folder_ / "published.lcm";
    config.publish.url = "file://" + log + "?mode=w";
    ASSERT_TRUE(RunRig(config, {.publish = true}, kGoOn).ok());

    const std::string picture = folder_ / "newest.png";
    int shown = -1;
    std::thread display([&] { shown = ViewVerb({.save = picture, .frames = kFrames}); });
    std::this_thread::sleep_for(milliseconds(300));  // it subscribes
    EXPECT_EQ(RunProgram(LCM_LOGPLAYER, {kUrl, "--speed=0.2", log}), 0);
    display.join();
    EXPECT_EQ(shown, 0);
    EXPECT_EQ(cv::imread(picture).size(), cv::Size(1024, 180));
}

}  // namespace
}  // namespace hitchview::app
