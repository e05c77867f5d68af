#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/device/vivid.hpp"
#include "tests/support/temporary_folder.hpp"

// `hitchview cameras` on eight virtual cameras.
namespace hitchview {
namespace {

using nlohmann::json;
using tests::Vivid;

constexpr int kCameras = 8;

class CamerasVerbTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
        vivid_ = std::make_unique<Vivid>(tests::VividOptions{.cameras = kCameras});
        ASSERT_TRUE(vivid_->loaded());
    }

    /// The exit code; what it prints goes to `text_`.
    int Cameras(const std::string& arguments, const std::string& before = "") {
        const std::string out = folder_ / "out.txt";
        const int status =
            std::system((before + HITCHVIEW + " cameras " + arguments + " >" + out).c_str());
        text_ = tests::FileText(out);
        return WEXITSTATUS(status);
    }
    json Json() const { return json::parse(tests::FileText(folder_ / "cameras.json")); }
    std::string WriteJson() const { return "--json " + (folder_ / "cameras.json"); }
    /// `more`: of the rear camera.
    std::string Rig(const std::string& rear, const std::string& size_px = "[640, 360]",
                    const std::string& more = "") {
        return "--rig " +
               folder_.Write("rig.yaml",
                             "schema: 1\n"
                             "canvas: {projection: plane, size_px: [1100, 520]}\n"
                             "units:\n"
                             "  tractor: {cameras: [{name: front, source: {v4l2: /dev/video0}}]}\n"
                             "  trailer: {cameras: [{name: rear, source: {v4l2: " +
                                 rear + ", size_px: " + size_px + ", format: yuyv" + more +
                                 "}}]}\n");
    }

    tests::TemporaryFolder folder_;
    std::unique_ptr<Vivid> vivid_;
    std::string text_;
};

TEST_F(CamerasVerbTest, ListsEightCamerasWithWhatTheyOfferAndOurPick) {
    ASSERT_EQ(Cameras(WriteJson()), 0);
    const json devices = Json().at("devices");
    ASSERT_EQ(devices.size(), kCameras);
    for (int i = 0; i < kCameras; ++i) {
        const std::string path = "/dev/video" + std::to_string(i);
        EXPECT_NE(text_.find(path + "  vivid   vivid  free   end of frame  nv12 1280x720 at 30 Hz"),
                  text_.npos)
            << text_;
        const json& device = devices.at(static_cast<std::size_t>(i));
        EXPECT_EQ(device.at("device"), path);
        EXPECT_EQ(device.at("pick").at("others"),
                  (std::vector<std::string>{"uyvy", "yuyv", "grey"}));
        EXPECT_GT(device.at("formats").size(), 4U);
        EXPECT_TRUE(device.at("read_speed").is_null());
    }
    EXPECT_TRUE(Json().at("rig").is_null());
}

TEST_F(CamerasVerbTest, NamesTheOneCameraOfARigThatIsMissing) {
    EXPECT_EQ(Cameras(Rig("/dev/video9") + " " + WriteJson()), 1);
    EXPECT_NE(text_.find("tractor  front   there    /dev/video0\n"), text_.npos) << text_;
    EXPECT_NE(text_.find("trailer  rear    MISSING  none\n  name    /dev/video9\n"), text_.npos)
        << text_;
    EXPECT_EQ(Json().at("rig")[1].at("problem"), "nothing is there");
}

TEST_F(CamerasVerbTest, FindsTheCamerasOfARigByNameAndPicksWhatItAsksFor) {
    std::filesystem::create_directories("/dev/v4l/by-path");
    const std::string name = "/dev/v4l/by-path/platform-vivid.0-usb-0:2.4.1:1.0-video-index0";
    std::filesystem::create_symlink("/dev/video5", name);
    EXPECT_EQ(Cameras(Rig(name) + " " + WriteJson()), 0) << text_;
    std::filesystem::remove(name);
    EXPECT_EQ(Json().at("rig")[1].at("device"), "/dev/video5");
    const json device = Json().at("devices")[5];
    // udev may have given this one its own name of all eight, which are at one place to it.
    EXPECT_THAT(device.at("names").get<std::vector<std::string>>(), testing::Contains(name));
    EXPECT_EQ(device.at("pick").at("format"), "yuyv");
    EXPECT_EQ(device.at("pick").at("size_px"), (std::vector<int>{640, 360}));
    EXPECT_EQ(Json().at("devices")[4].at("pick").at("format"), "nv12");
}

TEST_F(CamerasVerbTest, ACameraThatCannotGiveWhatTheRigAsksIsOfNoUse) {
    EXPECT_EQ(Cameras(Rig("/dev/video1", "[800, 600]")), 1);
    EXPECT_NE(text_.find("trailer  rear    UNUSABLE  /dev/video1\n"
                         "  name    /dev/video1\n"
                         "  why     wanted 800x600 at 30 Hz as yuyv, which it does not offer\n"),
              text_.npos)
        << text_;
}

TEST_F(CamerasVerbTest, WhatTheRigAsksToBeSetIsCheckedAndNotSet) {
    const auto problem = [&](const std::string& more) {
        EXPECT_EQ(Cameras(Rig("/dev/video1", "[640, 360]", more) + " " + WriteJson()), 1) << more;
        return Json().at("rig")[1].at("problem").get<std::string>();
    };
    EXPECT_EQ(problem(", input: 9").find("input 9 is not there; the device has 0 ("), 0U);
    EXPECT_EQ(problem(", controls: {brightness: 999}"),
              "control brightness is 999, must be 0 to 255");
    EXPECT_EQ(problem(", controls: {no_such_thing: 1}")
                  .find("control no_such_thing is not there; the device has "),
              0U);
    const std::string settable = ", rotation_deg: 180, controls: {brightness: 7}";
    EXPECT_EQ(Cameras(Rig("/dev/video1", "[640, 360]", settable)), 0) << text_;
    EXPECT_FALSE(
        tests::Shell("v4l2-ctl -d /dev/video1 -C brightness,vertical_flip | grep -qE ' (7|1)$'"));
}

TEST_F(CamerasVerbTest, MeasuresHowFastTheBuffersRead) {
    ASSERT_EQ(Cameras("--measure " + WriteJson()), 0);
    const json device = Json().at("devices")[0];
    EXPECT_GT(device.at("read_speed").at("buffer_gb_per_s").get<double>(), 0);
    EXPECT_NE(text_.find(" GB/s from a buffer"), text_.npos);
}

TEST_F(CamerasVerbTest, ACameraThatStreamsIsBusyAndGoesOn) {
    auto camera = drivers::V4l2Camera::Open(tests::VividCamera(2));
    ASSERT_TRUE(camera.ok()) << camera.error();
    ASSERT_EQ(Cameras("--measure " + WriteJson()), 0);
    EXPECT_EQ(Json().at("devices")[2].at("state"), "busy");
    EXPECT_TRUE(Json().at("devices")[2].at("read_speed").is_null());
    EXPECT_NE(text_.find("not measured: a program streams from it"), text_.npos) << text_;
    EXPECT_TRUE((*camera)->WaitFrame(std::chrono::milliseconds(1000)).ok());
}

TEST_F(CamerasVerbTest, ADeviceThatTheUserMayNotOpenIsForbiddenAndTheRemedyTold) {
    const std::string nobody = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
    ASSERT_TRUE(tests::Shell("chmod 600 /dev/video*"));
    EXPECT_EQ(Cameras("", nobody), 1);
    EXPECT_NE(text_.find("/dev/video1          vivid-001-vid-cap  forbidden"), text_.npos) << text_;
    EXPECT_NE(text_.find("add the user to group video"), text_.npos) << text_;
    ASSERT_TRUE(tests::Shell("chmod 666 /dev/video0"));
    EXPECT_EQ(Cameras("", nobody), 0);
    EXPECT_NE(text_.find("forbidden"), text_.npos) << text_;
}

TEST_F(CamerasVerbTest, WithoutAnyCameraSaysSo) {
    ASSERT_TRUE(vivid_->Unload());
    EXPECT_EQ(Cameras(WriteJson()), 1);
    EXPECT_NE(text_.find("No camera"), text_.npos);
    EXPECT_TRUE(Json().at("devices").empty());
    EXPECT_EQ(Cameras(Rig("/dev/video1")), 1);
    ASSERT_TRUE(vivid_->Load());
}

TEST_F(CamerasVerbTest, AWrongRigFileAndAFileThatCannotBeWrittenAreToldApart) {
    EXPECT_EQ(Cameras(Rig("video1")), 2);
    EXPECT_EQ(Cameras("--json /nowhere/cameras.json"), 3);
}

}  // namespace
}  // namespace hitchview
