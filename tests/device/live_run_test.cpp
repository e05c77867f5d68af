#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.hpp"
#include "tests/device/live_report.hpp"
#include "tests/device/vivid.hpp"
#include "tests/support/recorded_events.hpp"
#include "tests/support/simulated_rig_files.hpp"

// The program on eight virtual cameras, publishing over LCM.
namespace hitchview::app {
namespace {

using nlohmann::json;
using tests::Count;
using tests::Vivid;

constexpr int kCameras = 8;
constexpr int kFrames = 150;

class LiveRunTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
        vivid_ = std::make_unique<Vivid>(tests::VividOptions{.cameras = kCameras});
        ASSERT_TRUE(vivid_->loaded());
        tests::Shell("ip route add 224.0.0.0/4 dev lo 2>/dev/null");
        tests::WriteSimulatedCalibration(folder_, 1280, 720);
    }

    /// Camera i has the path of the device i, but for `absent`: that leads nowhere yet.
    std::string Rig(int absent = -1) {
        int device = 0;
        return folder_.Write(
            "rig.yaml",
            "schema: 1\ncanvas: {projection: cylinder}\n"
            "calibration: rig.calib.yaml\n" +
                tests::SimulatedUnits([&](const std::string&) {
                    const int number = device++;
                    return "{v4l2: " + (number == absent ? AbsentPath() : Device(number)) +
                           ", format: uyvy}";
                }));
    }
    static std::string Device(int number) { return "/dev/video" + std::to_string(number); }
    [[nodiscard]] std::string AbsentPath() const { return folder_ / "absent"; }
    json Report(int frames) {
        EXPECT_EQ(RunProgram(HITCHVIEW, {"run", "--rig", Rig(), "--out", folder_ / "out",
                                         "--frames", std::to_string(frames)}),
                  0);
        return json::parse(tests::FileText(folder_ / "out/report.json"));
    }

    tests::TemporaryFolder folder_;
    std::unique_ptr<Vivid> vivid_;
};

TEST_F(LiveRunTest, EveryFrameOfEightCamerasIsAccountedFor) {
    const json report = Report(kFrames);
    const json& live = report.at("live");
    std::printf("%s\n%s\n", live.dump().c_str(), report.at("stages").dump().c_str());
    EXPECT_EQ(report.at("frames"), kFrames);
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0) << report.at("heap_calls_by_thread");
    ASSERT_EQ(live.at("cameras").size(), kCameras);
    tests::ExpectFramesAccountedFor(report);
    for (const auto& [name, camera] : live.at("cameras").items()) {
        EXPECT_GT(Count(camera, "taken"), kFrames / 2) << name;
        EXPECT_EQ(Count(camera, "corrupted"), 0) << name;
        EXPECT_NEAR(camera.at("period_ms").get<double>(), 33.3, 1) << name;
    }
    const json& sets = live.at("sets");
    // A machine that is too busy leaves sets out (`skipped`); it makes none without frames.
    EXPECT_GE(Count(sets, "complete") + Count(sets, "partial"), kFrames);
    EXPECT_GT(Count(sets, "complete"), kFrames / 3);
    EXPECT_EQ(Count(sets, "empty"), 0);
    EXPECT_LE(live.at("spread").at("max_ms").get<double>(), 33.4);
}

/// Every frame that the cameras gave is in the log, or counted as left out.
TEST_F(LiveRunTest, EveryFrameIsRecordedOrCounted) {
    const std::string drives = folder_ / "drives";
    ASSERT_EQ(RunProgram(HITCHVIEW, {"record", "--rig", Rig(), "--out", drives, "--seconds", "5",
                                     "--min-free-mb", "0"}),
              0);
    const json report = json::parse(tests::FileText(folder_ / "drives/report.json"));
    std::printf("%s\n", report.at("recording").dump().c_str());
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0) << report.at("heap_calls_by_thread");
    std::map<std::string, int> channels;
    for (const auto& event : tests::RecordedEvents(drives)) ++channels[event.channel];
    int recorded = 0;
    for (const auto& [name, camera] : report.at("recording").at("cameras").items()) {
        recorded += camera.at("recorded").get<int>();
        EXPECT_LE(Count(camera, "recorded") + Count(camera, "dropped"),
                  Count(report.at("live").at("cameras").at(name), "delivered"))
            << name;
    }
    int logged = 0;
    for (const auto& [channel, messages] : channels)
        logged += channel.starts_with("CAM_") ? messages : 0;
    EXPECT_EQ(logged, recorded);
    EXPECT_GT(recorded, 0);
    EXPECT_EQ(channels["RIG"], 1);
    EXPECT_GT(channels["PANORAMA_STATUS"], 0);
}

TEST_F(LiveRunTest, ACameraThatComesWhileItRecordsIsRecordedFromThenOn) {
    const std::string drives = folder_ / "drives";
    std::thread appearing([&] {
        std::this_thread::sleep_for(std::chrono::seconds(4));
        std::filesystem::create_symlink(Device(3), AbsentPath());
    });
    EXPECT_EQ(RunProgram(HITCHVIEW, {"record", "--rig", Rig(3), "--out", drives, "--seconds", "6",
                                     "--min-free-mb", "0"}),
              0);
    appearing.join();
    const json report = json::parse(tests::FileText(folder_ / "drives/report.json"));
    std::printf("%s\n", report.at("recording").dump().c_str());
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0) << report.at("heap_calls_by_thread");
    const json& recorded = report.at("recording").at("cameras");
    for (const auto& [name, camera] : report.at("live").at("cameras").items()) {
        EXPECT_EQ(Count(camera, "reopened"), name == "left" ? 1U : 0U) << name;
        EXPECT_GT(Count(recorded.at(name), "recorded"), 0U) << name;
    }
}

}  // namespace
}  // namespace hitchview::app
