#include <gtest/gtest.h>

#include "app/config.hpp"
#include "tests/support/temporary_folder.hpp"

// Live cameras in a rig file.
namespace hitchview::app {
namespace {

using algo::Unit;

class ConfigLiveTest : public testing::Test {
 protected:
    hal::Checked<RigConfig> LoadText(const std::string& text) {
        return LoadRigConfig(folder_.Write("rig.yaml", text));
    }
    /// A rig of one unit with these `cameras`, and more keys.
    hal::Checked<RigConfig> Load(const std::string& cameras, const std::string& more = "") {
        return LoadText(
            "schema: 1\n"
            "canvas: {projection: cylinder}\n"
            "calibration: rig.calib.yaml\n"
            "units: {tractor: {cameras: [" +
            cameras + "]}}\n" + more);
    }
    /// What is said of one camera with this source, without the file's name.
    std::string RefusalOf(const std::string& source, const std::string& more = "") {
        return Refusal("{name: a, source: {" + source + "}}", more);
    }
    std::string Refusal(const std::string& cameras, const std::string& more = "") {
        const auto config = Load(cameras, more);
        if (config) return "none";
        std::string error = config.error();
        const std::string folder = folder_.path() + '/';
        for (auto at = error.find(folder); at != error.npos; at = error.find(folder))
            error.erase(at, folder.size());
        return error;
    }

    tests::TemporaryFolder folder_;
};

TEST_F(ConfigLiveTest, ADeviceIsEnough) {
    const auto config = Load("{name: a, source: {v4l2: /dev/video3}}");
    ASSERT_TRUE(config.ok()) << config.error();
    const CameraConfig& camera = config.value().units[Unit::kTractor].cameras.at(0);
    EXPECT_TRUE(camera.IsLive());
    EXPECT_EQ(camera.live.device, "/dev/video3");
    EXPECT_EQ(camera.live.size_px.width_px, 1280);
    EXPECT_EQ(camera.live.size_px.height_px, 720);
    EXPECT_EQ(camera.live.format, "best");
    EXPECT_EQ(camera.live.input, -1);
    EXPECT_EQ(camera.live.buffers, 0);
    EXPECT_TRUE(camera.live.controls.empty());
    EXPECT_FALSE(config.value().set_tolerance);
}

TEST_F(ConfigLiveTest, WhatTheFileSaysReplacesTheDefaults) {
    const auto config = Load(
        "{name: a, source: {v4l2: /dev/hitchview/front, size_px: [1920, 1080], format: uyvy,"
        " input: 2, buffers: 12, rotation_deg: 180, flip: both,"
        " controls: {auto_exposure: Manual Mode, exposure_time_absolute: 100, 0x00980911: -3}}}",
        "period_ms: 40\nset_tolerance_ms: 12.5\n");
    ASSERT_TRUE(config.ok()) << config.error();
    const LiveCameraConfig& live = config.value().units[Unit::kTractor].cameras.at(0).live;
    EXPECT_EQ(live.device, "/dev/hitchview/front");
    EXPECT_EQ(live.size_px.width_px, 1920);
    EXPECT_EQ(live.size_px.height_px, 1080);
    EXPECT_EQ(live.format, "uyvy");
    EXPECT_EQ(live.input, 2);
    EXPECT_EQ(live.buffers, 12);
    EXPECT_EQ(live.rotation_deg, 180);
    EXPECT_TRUE(live.horizontal_flip);
    EXPECT_TRUE(live.vertical_flip);
    EXPECT_EQ(*config.value().set_tolerance, std::chrono::microseconds(12500));
    // In the order of the file: automatic exposure goes off before the exposure is set.
    ASSERT_EQ(live.controls.size(), 3U);
    EXPECT_EQ(live.controls[0].name, "auto_exposure");
    EXPECT_EQ(live.controls[0].value, "Manual Mode");
    EXPECT_EQ(live.controls[1].name, "exposure_time_absolute");
    EXPECT_EQ(live.controls[1].value, "100");
    EXPECT_EQ(live.controls[2].name, "0x00980911");
    EXPECT_EQ(live.controls[2].value, "-3");
}

TEST_F(ConfigLiveTest, OneMirrorIsNotTheOther) {
    for (const std::string flip : {"none", "horizontal", "vertical"}) {
        const auto config = Load("{name: a, source: {v4l2: /dev/video0, flip: " + flip + "}}");
        ASSERT_TRUE(config.ok()) << config.error();
        const LiveCameraConfig& live = config.value().units[Unit::kTractor].cameras.at(0).live;
        EXPECT_EQ(live.horizontal_flip, flip == "horizontal");
        EXPECT_EQ(live.vertical_flip, flip == "vertical");
    }
}

struct BadSource {
    std::string source;
    std::string complaint;  ///< behind the path of the source
};

class BadLiveCameraTest : public ConfigLiveTest, public testing::WithParamInterface<BadSource> {};

TEST_P(BadLiveCameraTest, IsRefusedWithFileLineKeyAndWhatIsAllowed) {
    EXPECT_EQ(RefusalOf(GetParam().source),
              "rig.yaml:4: units.tractor.cameras[0].source" + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, BadLiveCameraTest,
    testing::Values(
        BadSource{"v4l2: video0",
                  ".v4l2 is video0, must be the absolute path of a device, best one of "
                  "/dev/v4l/by-path"},
        BadSource{"v4l2: \"\"", ".v4l2 is \"\", must be text"},
        BadSource{"v4l2: [/dev/video0]", ".v4l2 is a list of 1, must be text"},
        BadSource{"v4l2: /dev/video0, size_px: [641, 480]",
                  ".size_px[0] is 641, must be 64 to 4096 and even"},
        BadSource{"v4l2: /dev/video0, size_px: [640, 8192]",
                  ".size_px[1] is 8192, must be 64 to 4096 and even"},
        BadSource{"v4l2: /dev/video0, format: rgb3",
                  ".format is rgb3, must be one of best, nv12, nm12, uyvy, yuyv, mjpeg, grey"},
        BadSource{"v4l2: /dev/video0, input: -1", ".input is -1, must be 0 to 63"},
        BadSource{"v4l2: /dev/video0, buffers: 1", ".buffers is 1, must be 2 to 32"},
        BadSource{"v4l2: /dev/video0, buffers: 33", ".buffers is 33, must be 2 to 32"},
        BadSource{"v4l2: /dev/video0, rotation_deg: 90", ".rotation_deg is 90, must be 0 or 180"},
        BadSource{"v4l2: /dev/video0, flip: left",
                  ".flip is left, must be one of none, horizontal, vertical, both"},
        BadSource{"v4l2: /dev/video0, controls: [1]", ".controls is a list of 1, must be a map"},
        BadSource{"v4l2: /dev/video0, controls: {gain: [1]}",
                  ".controls.gain is a list of 1, must be text"},
        BadSource{"v4l2: /dev/video0, rate_hz: 30",
                  ".rate_hz is no key, must be one of simulated, replay, v4l2, libcamera, "
                  "size_px, buffers, rotation_deg, flip, controls, format, input"},
        BadSource{
            "v4l2: /dev/video0, replay: a.avi",
            " is a map, must be a map with exactly one of simulated, replay, v4l2 and libcamera"},
        BadSource{"replay: a.avi, size_px: [640, 480]",
                  ".size_px is no key, must be one of simulated, replay, v4l2, libcamera"}));

TEST_F(ConfigLiveTest, OneDeviceIsNotTwoCameras) {
    EXPECT_EQ(Refusal("{name: a, source: {v4l2: /dev/video0}}, "
                      "{name: b, source: {v4l2: /dev/video0, size_px: [640, 480]}}"),
              "rig.yaml:4: units.tractor.cameras[1].source is a map, must be a device of its own");
}

TEST_F(ConfigLiveTest, TwoDevicesThatAreNotSaidAreNotTheSame) {
    const std::string cameras = "units.tractor.cameras";
    EXPECT_EQ(Refusal("{name: a, source: {v4l2: \"\"}}, {name: b, source: {v4l2: \"\"}}"),
              "rig.yaml:4: " + cameras + "[0].source.v4l2 is \"\", must be text\n" +
                  "rig.yaml:4: " + cameras + "[1].source.v4l2 is \"\", must be text");
}

TEST_F(ConfigLiveTest, LiveAndRecordedCamerasDoNotMix) {
    for (const std::string other : {"{replay: b.avi}", "{simulated: true}"}) {
        EXPECT_EQ(
            Refusal("{name: a, source: {v4l2: /dev/video0}}, {name: b, source: " + other + "}"),
            "rig.yaml:4: units is a map, must be units whose cameras are all live (v4l2, "
            "libcamera), "
            "or none");
    }
}

TEST_F(ConfigLiveTest, ASetMayNotBeLooserThanAPeriod) {
    EXPECT_EQ(RefusalOf("v4l2: /dev/video0", "period_ms: 20\nset_tolerance_ms: 21\n"),
              "rig.yaml:6: set_tolerance_ms is 21, must be 1 to 20");
    EXPECT_EQ(RefusalOf("v4l2: /dev/video0", "set_tolerance_ms: 0.5\n"),
              "rig.yaml:5: set_tolerance_ms is 0.5, must be 1 to 33.333333");
    EXPECT_EQ(RefusalOf("replay: a.avi", "set_tolerance_ms: 5\n"),
              "rig.yaml:5: set_tolerance_ms is 5, must be absent unless the cameras are live "
              "(v4l2, libcamera, simulation.live)");
}

TEST_F(ConfigLiveTest, ASetMayBeAsLooseAsAPeriod) {
    for (const std::string period_ms : {"33.333", "40", "16.667", "8.3", "999.999"}) {
        EXPECT_EQ(RefusalOf("v4l2: /dev/video0",
                            "period_ms: " + period_ms + "\nset_tolerance_ms: " + period_ms + "\n"),
                  "none");
    }
}

/// The lines of the example that show live cameras, which a rig of recordings cannot have beside
/// its own, without their '#'.
std::string LiveCamerasOfTheExample() {
    std::istringstream example(tests::FileText(HITCHVIEW_SOURCE_DIR "/docs/rig.example.yaml"));
    const std::string mark = "    # ";
    std::string text;
    for (std::string line; std::getline(example, line);) {
        const bool starts = line.starts_with(mark + "cameras:");
        if (starts || (!text.empty() && line.starts_with(mark)))
            text += "    " + line.substr(mark.size()) + '\n';
        else if (!text.empty())
            break;
    }
    return text;
}

TEST_F(ConfigLiveTest, TheLiveCameraOfTheExampleLoadsAndShowsTheDefaults) {
    const std::string cameras = LiveCamerasOfTheExample();
    const auto config = LoadText(
        "schema: 1\ncanvas: {projection: cylinder}\ncalibration: rig.calib.yaml\n"
        "units:\n  tractor:\n" +
        cameras);
    ASSERT_TRUE(config.ok()) << config.error() << cameras;
    const auto& loaded = config.value().units[Unit::kTractor].cameras;
    ASSERT_EQ(loaded.size(), 1U);
    const LiveCameraConfig& live = loaded[0].live;
    const LiveCameraConfig defaults;
    EXPECT_TRUE(live.device.starts_with("/dev/v4l/by-path/")) << live.device;
    EXPECT_EQ(live.size_px.width_px, defaults.size_px.width_px);
    EXPECT_EQ(live.size_px.height_px, defaults.size_px.height_px);
    EXPECT_EQ(live.format, defaults.format);
    EXPECT_EQ(live.rotation_deg, defaults.rotation_deg);
    EXPECT_EQ(live.horizontal_flip, defaults.horizontal_flip);
    EXPECT_FALSE(live.controls.empty());
}

}  // namespace
}  // namespace hitchview::app
