#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "drivers/systemd_journal.hpp"
#include "tests/device/live_program.hpp"
#include "tests/device/live_report.hpp"
#include "tests/support/datagram_listener.hpp"

// The program on eight virtual cameras, one of which fails while it runs.
namespace hitchview::app {
namespace {

using hal::Instant;
using nlohmann::json;
using std::chrono::milliseconds;
using tests::Count;
using tests::HeardEvent;
using tests::LiveProgram;
using tests::Outage;
using tests::PanoramaListener;
using tests::Vivid;

constexpr std::size_t kFaulty = 2;
constexpr const char* kFaultyName = "right_front";
/// What a busy machine may cost a camera that nothing befell.
constexpr milliseconds kLongestSoundOutage{200};
/// From before v4l2-ctl starts until the first panorama without the camera.
constexpr milliseconds kLongestNotice{500};
constexpr milliseconds kLongestReturn{1000};
constexpr double kLeastRate_hz = 27;

double Ms(Instant duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

class LiveFaultTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
    }
    void TearDown() override {
        program_.reset();  // it holds the cameras
        vivid_.reset();
    }

    void Load(int hdmi_camera = -1) {
        vivid_ = std::make_unique<Vivid>(
            tests::VividOptions{.cameras = LiveProgram::kCameras, .hdmi_camera = hdmi_camera});
        ASSERT_TRUE(vivid_->loaded());
        if (hdmi_camera >= 0) SetTimings(tests::k1280x720p30);
    }
    void Start(int hdmi_camera = -1) {
        ASSERT_NO_FATAL_FAILURE(Load(hdmi_camera));
        program_ = std::make_unique<LiveProgram>();
        ASSERT_TRUE(program_->Start());
    }

    /// The moment before it is done.
    static Instant Set(const char* control, int value) {
        const Instant at = PanoramaListener::Now();
        EXPECT_TRUE(Vivid::Set(kFaulty, control, value)) << control;
        return at;
    }
    static Instant SetTimings(int timings) {
        Set("dv_timings_signal_mode", tests::kSelectedSignal);
        return Set("dv_timings", timings);
    }
    static void Pass(milliseconds time) { std::this_thread::sleep_for(time); }

    /// Lets the camera come back and a second pass, then ends the program. Nothing but the one
    /// camera has suffered, and the counts agree.
    void Finish(const char* fault) {
        Pass(kLongestReturn + milliseconds(1000));
        report_ = program_->Finish();
        std::printf("%s: sound cameras missing at most %.0f ms, %.1f panoramas/s\n", fault,
                    Ms(LongestSoundOutage()), report_.at("frames_per_second").get<double>());
        EXPECT_LE(LongestSoundOutage(), kLongestSoundOutage);
        EXPECT_GE(report_.at("frames_per_second").get<double>(), kLeastRate_hz);
        EXPECT_EQ(report_.at("heap_calls_after_ready"), 0) << report_.at("heap_calls_by_thread");
        EXPECT_EQ(Count(report_.at("live").at("sets"), "empty"), 0U);
        tests::ExpectFramesAccountedFor(report_);
        ExpectSpreadsOfOnePeriod();
        for (const auto& [name, camera] : report_.at("live").at("cameras").items()) {
            EXPECT_NEAR(camera.at("period_ms").get<double>(), 33.3, 1) << name;
            if (name == kFaultyName) continue;
            EXPECT_EQ(Count(camera, "reopened") + Count(camera, "corrupted"), 0U) << name;
        }
    }

    /// The cameras run freely, each at a moment of its own.
    void ExpectSpreadsOfOnePeriod() {
        for (const tests::HeardStatus& status : program_->statuses()) {
            EXPECT_GT(status.spread, Instant(0));
            EXPECT_LE(Ms(status.spread), 33.4);
        }
    }

    [[nodiscard]] std::vector<Outage> Outages(std::size_t camera) const {
        return tests::OutagesOf(camera, program_->statuses());
    }
    [[nodiscard]] Instant LongestSoundOutage() const {
        Instant longest{};
        for (std::size_t camera = 0; camera < LiveProgram::kCameras; ++camera) {
            if (camera != kFaulty) longest = std::max(longest, tests::Longest(Outages(camera)));
        }
        return longest;
    }
    [[nodiscard]] std::uint64_t FaultyCount(const char* key) const {
        return Count(report_.at("live").at("cameras").at(kFaultyName), key);
    }

    /// Missing from soon after the fault until soon after its end, all the time. Without an
    /// `end_at` the fault ends when the program lets go of the camera.
    void ExpectOutage(Instant fault_at, std::optional<Instant> end_at = std::nullopt) {
        ASSERT_FALSE(program_->events().empty());
        const Instant end = end_at.value_or(program_->events().front().when);
        const auto outages = Outages(kFaulty);
        ASSERT_FALSE(outages.empty());
        const auto longest =
            std::ranges::max_element(outages, {}, [](const Outage& o) { return o.until - o.from; });
        std::printf("  fault to missing %.0f ms, end to back %.0f ms\n",
                    Ms(longest->from - fault_at), Ms(longest->until - end));
        EXPECT_GE(longest->from, fault_at);
        EXPECT_LE(longest->from - fault_at, kLongestNotice);
        EXPECT_GE(longest->until, end);
        EXPECT_LE(longest->until - end, kLongestReturn);
        for (const Outage& other : outages) {
            if (other.from == longest->from) continue;
            EXPECT_LE(other.until - other.from, kLongestSoundOutage);
        }
    }
    /// Missing from the first panorama on until soon after it could be had.
    void ExpectAbsence(Instant until) {
        const auto outages = Outages(kFaulty);
        ASSERT_EQ(outages.size(), 1U);
        std::printf("  there to shown %.0f ms\n", Ms(outages[0].until - until));
        EXPECT_EQ(outages[0].from, program_->statuses().front().at);
        EXPECT_GE(outages[0].until, until);
        EXPECT_LE(outages[0].until - until, kLongestReturn);
        EXPECT_EQ(FaultyCount("reopened"), 1U);
    }
    /// Missing now and then at most.
    void ExpectShortOutages(milliseconds longest) {
        std::printf("  %zu outages of at most %.0f ms\n", Outages(kFaulty).size(),
                    Ms(tests::Longest(Outages(kFaulty))));
        EXPECT_LE(tests::Longest(Outages(kFaulty)), longest);
    }

    /// Told once that it is lost and why, and once that it is back.
    void ExpectEvents(const std::string& why) {
        const auto events = program_->events();
        for (const HeardEvent& event : events) {
            std::printf("  event %d, %s: %s; heard %.1f ms later\n", event.code,
                        event.subject.c_str(), event.text.c_str(), Ms(event.at - event.when));
            EXPECT_EQ(event.subject, kFaultyName);
        }
        ASSERT_EQ(events.size(), 2U);
        EXPECT_EQ(events[0].code, HITCHVIEW_EVENT_T_CAMERA_LOST);
        EXPECT_EQ(events[0].text, "lost: " + why);
        EXPECT_EQ(events[1].code, HITCHVIEW_EVENT_T_CAMERA_BACK);
        EXPECT_TRUE(events[1].text.starts_with("back after ")) << events[1].text;
        ExpectEventCounts(1);
        EXPECT_GE(FaultyCount("reopened"), 1U);
    }
    void ExpectNoEvents() {
        EXPECT_EQ(program_->events().size(), 0U);
        ExpectEventCounts(0);
    }
    void ExpectEventCounts(int of_each) {
        const json& events = report_.at("events");
        EXPECT_EQ(events.at("camera_lost"), of_each);
        EXPECT_EQ(events.at("camera_back"), of_each);
        EXPECT_EQ(events.at("refused"), 0);
    }

    std::unique_ptr<Vivid> vivid_;
    std::unique_ptr<LiveProgram> program_;
    json report_;
};

TEST_F(LiveFaultTest, ACameraThatIsPulledOutAndComesBackIsShownAgain) {
    ASSERT_NO_FATAL_FAILURE(Start());
    // A device that was disconnected is there again once nobody has it open.
    const int held = open(tests::VividCamera(kFaulty).path.c_str(), O_RDWR);
    ASSERT_GE(held, 0);
    const Instant fault_at = Set("disconnect", 1);
    Pass(milliseconds(2000));
    const Instant end_at = PanoramaListener::Now();
    close(held);
    Finish("pulled out for 2 s");
    ExpectOutage(fault_at, end_at);
    ExpectEvents("disconnected");
    EXPECT_EQ(FaultyCount("reopened"), 1U);
}

TEST_F(LiveFaultTest, ACameraThatIsAbsentAtTheStartIsTakenInWhenItComes) {
    ASSERT_NO_FATAL_FAILURE(Load());
    program_ = std::make_unique<LiveProgram>(kFaulty);
    ASSERT_TRUE(program_->Start(1U << kFaulty));
    Pass(milliseconds(2000));
    const Instant there_at = PanoramaListener::Now();
    program_->Appear();
    Finish("absent at the start");
    ExpectAbsence(there_at);
    ExpectEvents("disconnected");
}

TEST_F(LiveFaultTest, ACameraThatAnotherProgramHasAtTheStartIsTakenInWhenItIsFree) {
    ASSERT_NO_FATAL_FAILURE(Load());
    auto other = drivers::V4l2Camera::Open(tests::VividCamera(kFaulty));
    ASSERT_TRUE(other) << other.error();
    program_ = std::make_unique<LiveProgram>();
    ASSERT_TRUE(program_->Start(1U << kFaulty));
    const Instant there_at = PanoramaListener::Now();
    other.value().reset();
    Finish("busy at the start");
    ExpectAbsence(there_at);
    ExpectEvents("in use by another program");
}

TEST_F(LiveFaultTest, WhatBefallsACameraStandsInTheJournalToo) {
    std::filesystem::create_directories("/run/systemd/journal");
    tests::DatagramListener journal(drivers::SystemdJournal::kSocket);
    setenv("JOURNAL_STREAM", "8:1", 1);
    ASSERT_NO_FATAL_FAILURE(Start());
    unsetenv("JOURNAL_STREAM");
    Set("inject_fatal_streaming_error", 1);
    Finish("written to the journal");
    ExpectEvents("I/O error");
    std::vector<std::string> entries;
    for (const std::string& entry : journal.TakeAll())
        if (entry.find("\nCAMERA=") != std::string::npos) entries.push_back(entry);
    ASSERT_EQ(entries.size(), 2U);
    const std::string message = std::string("MESSAGE=camera ") + kFaultyName + ": ";
    EXPECT_TRUE(entries[0].starts_with(message + "lost: I/O error\n")) << entries[0];
    EXPECT_TRUE(entries[1].starts_with(message + "back after ")) << entries[1];
}

TEST_F(LiveFaultTest, WithoutAnyCameraPanoramasOfNoDataAreMadeAndTheServiceManagerIsFed) {
    constexpr milliseconds kGone{2000};
    constexpr int kExpectedFeeds = 60;
    tests::DatagramListener manager("@hitchview-live-fault-test");
    setenv("NOTIFY_SOCKET", "@hitchview-live-fault-test", 1);
    ASSERT_NO_FATAL_FAILURE(Start());
    unsetenv("NOTIFY_SOCKET");
    std::vector<int> held;  // a device that was disconnected comes back when nobody has it open
    for (std::size_t i = 0; i < LiveProgram::kCameras; ++i) {
        held.push_back(open(tests::VividCamera(static_cast<int>(i)).path.c_str(), O_RDWR));
        EXPECT_TRUE(Vivid::Set(static_cast<int>(i), "disconnect", 1));
    }
    Pass(milliseconds(500));
    EXPECT_EQ(program_->statuses().back().cameras_missing, 0xFFU);
    manager.TakeAll();  // from before
    const std::size_t before = program_->statuses().size();
    int feeds = 0;
    const Instant end = PanoramaListener::Now() + kGone;
    while (PanoramaListener::Now() < end)
        if (manager.Take(milliseconds(10)) == "WATCHDOG=1") ++feeds;
    std::printf("no camera for 2 s: %zu panoramas, fed %d times\n",
                program_->statuses().size() - before, feeds);
    EXPECT_EQ(program_->statuses().back().cameras_missing, 0xFFU);
    EXPECT_GT(program_->statuses().size() - before, kExpectedFeeds / 2);
    EXPECT_GT(feeds, kExpectedFeeds / 2);
    for (const int file : held) close(file);
    Pass(kLongestReturn + milliseconds(1000));
    EXPECT_EQ(program_->statuses().back().cameras_missing, 0U);
    report_ = program_->Finish();
    EXPECT_EQ(report_.at("heap_calls_after_ready"), 0) << report_.at("heap_calls_by_thread");
}

TEST_F(LiveFaultTest, ACameraThatFailsAndDoesNotStreamAtOnceIsTriedAgain) {
    ASSERT_NO_FATAL_FAILURE(Start());
    Set("inject_vidioc_streamon_error", 1);
    const Instant fault_at = Set("inject_fatal_streaming_error", 1);
    Finish("stream-on refused");
    ExpectOutage(fault_at);
    ExpectEvents("I/O error");
    EXPECT_EQ(FaultyCount("reopened"), 1U);
}

TEST_F(LiveFaultTest, ACameraThatStallsIsMissingUntilItGoesOn) {
    ASSERT_NO_FATAL_FAILURE(Start());
    const Instant fault_at = Set("percentage_of_dropped_buffers", 100);
    Pass(milliseconds(2000));
    const Instant end_at = Set("percentage_of_dropped_buffers", 0);
    Finish("stall of 2 s");
    ExpectOutage(fault_at, end_at);
    ExpectEvents("silent");
}

TEST_F(LiveFaultTest, DamagedFramesAreLeftOutAndTheCameraIsNotLost) {
    constexpr int kDamaged = 5;
    ASSERT_NO_FATAL_FAILURE(Start());
    for (int i = 0; i < kDamaged; ++i) {
        Set("inject_v4l2_buf_flag_error", 1);
        Pass(milliseconds(200));
    }
    Finish("5 damaged frames");
    ExpectShortOutages(kLongestSoundOutage);
    ExpectNoEvents();
    EXPECT_FALSE(Outages(kFaulty).empty());
    EXPECT_EQ(FaultyCount("corrupted"), kDamaged);
    EXPECT_EQ(FaultyCount("reopened"), 0U);
}

TEST_F(LiveFaultTest, ASignalThatIsLostAndComesBackIsFollowed) {
    ASSERT_NO_FATAL_FAILURE(Start(kFaulty));
    const Instant fault_at = Set("dv_timings_signal_mode", tests::kNoSignal);
    Pass(milliseconds(2000));
    const Instant end_at = Set("dv_timings_signal_mode", tests::kSelectedSignal);
    Finish("no signal");
    ExpectOutage(fault_at, end_at);
    ExpectEvents("no signal");
}

TEST_F(LiveFaultTest, ASignalOfAnotherRateIsRefusedUntilItIsOursAgain) {
    ASSERT_NO_FATAL_FAILURE(Start(kFaulty));
    const Instant fault_at = SetTimings(tests::k1280x720p60);
    Pass(milliseconds(2000));
    const Instant end_at = SetTimings(tests::k1280x720p30);
    Finish("signal of 60 Hz");
    ExpectOutage(fault_at, end_at);
    ExpectEvents("another format");
}

TEST_F(LiveFaultTest, ASignalOfAnotherSizeThatTheDeviceScalesGoesOnByItself) {
    ASSERT_NO_FATAL_FAILURE(Start(kFaulty));
    for (const int timings : {tests::k1920x1080p30, tests::k1280x720p30}) {
        SetTimings(timings);
        Pass(milliseconds(1000));
    }
    Finish("signal of another size, twice");
    ExpectShortOutages(kLongestNotice);
    ExpectNoEvents();
    EXPECT_EQ(FaultyCount("reopened"), 2U);
}

}  // namespace
}  // namespace hitchview::app
