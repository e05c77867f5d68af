#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "app/camera_match.hpp"
#include "app/camera_table.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hitchview::app {
namespace {

using testing::HasSubstr;

/// Files stand for devices: only their paths matter here.
class CameraMatchTest : public testing::Test {
 protected:
    CameraMatchTest() {
        for (const char* name : {"video0", "video1"}) {
            CameraDevice device;
            device.path = folder_.Write(name, "");
            device.names = {"/dev/v4l/by-path/" + std::string(name)};
            device.pick = CameraPick{"uyvy", {1280, 720}, 30, false, {}};
            devices_.push_back(device);
        }
    }

    static RigConfig Rig(const std::string& tractor, const std::string& trailer) {
        RigConfig rig;
        rig.units[algo::Unit::kTractor].cameras.push_back(Camera("front", tractor));
        rig.units[algo::Unit::kTrailer].cameras.push_back(Camera("rear", trailer));
        return rig;
    }
    static CameraConfig Camera(const std::string& name, const std::string& device) {
        CameraConfig camera;
        camera.name = name;
        camera.source = CameraConfig::Source::kV4l2;
        camera.live.device = device;
        return camera;
    }
    std::vector<CameraMatch> Match(const std::string& tractor, const std::string& trailer) {
        return MatchCameras(Rig(tractor, trailer), devices_);
    }

    tests::TemporaryFolder folder_;
    std::vector<CameraDevice> devices_;
};

TEST_F(CameraMatchTest, FindsADeviceByItsPathAndByItsName) {
    const auto matches = Match(devices_[1].path, "/dev/v4l/by-path/video0");
    ASSERT_EQ(matches.size(), 2U);
    EXPECT_EQ(matches[0].name, "front");
    EXPECT_EQ(matches[0].device, devices_[1].path);
    EXPECT_EQ(matches[1].unit, algo::Unit::kTrailer);
    EXPECT_EQ(matches[1].device, devices_[0].path);
    EXPECT_TRUE(AllThere(matches));
}

TEST_F(CameraMatchTest, FindsADeviceByAnyLinkToIt) {
    std::filesystem::create_symlink(devices_[1].path, folder_ / "trailer-rear");
    EXPECT_EQ(Match(devices_[0].path, folder_ / "trailer-rear")[1].device, devices_[1].path);
}

TEST_F(CameraMatchTest, TellsWhichCameraIsMissing) {
    const auto matches = Match(devices_[0].path, folder_ / "video2");
    EXPECT_EQ(matches[0].problem, "");
    EXPECT_EQ(matches[1].device, "");
    EXPECT_EQ(matches[1].problem, "nothing is there");
    EXPECT_FALSE(AllThere(matches));
}

TEST_F(CameraMatchTest, WhatIsNoCameraIsToldApartFromNothing) {
    EXPECT_EQ(Match(devices_[0].path, folder_.Write("video2", ""))[1].problem,
              "it is there, but is no camera");
}

TEST_F(CameraMatchTest, TwoNamesOfOneDeviceDoNotMakeTwoCameras) {
    const auto matches = Match(devices_[0].path, devices_[0].names[0]);
    EXPECT_EQ(matches[0].problem, "");
    EXPECT_EQ(matches[1].problem, "camera front has it");
}

TEST_F(CameraMatchTest, ADeviceThatMayNotBeOpenedIsOfNoUse) {
    devices_[1].state = CameraDevice::State::kForbidden;
    devices_[1].refusal = "open: Permission denied";
    const auto matches = Match(devices_[0].path, devices_[1].path);
    EXPECT_THAT(matches[1].problem, HasSubstr("add the user to group video"));
    EXPECT_FALSE(AllThere(matches));
}

TEST_F(CameraMatchTest, ADeviceThatCannotGiveWhatIsAskedIsOfNoUse) {
    devices_[1].pick.reset();
    devices_[1].no_pick = "wanted 1920x1080";
    EXPECT_EQ(Match(devices_[0].path, devices_[1].path)[1].problem, "wanted 1920x1080");
}

TEST_F(CameraMatchTest, ADeviceThatCannotBeSetAsTheRigAsksIsOfNoUse) {
    devices_[1].unsettable = "control zoom is not there";
    const auto matches = Match(devices_[0].path, devices_[1].path);
    EXPECT_EQ(matches[1].problem, "control zoom is not there");
    EXPECT_FALSE(AllThere(matches));
    devices_[1].no_pick = "wanted 1920x1080";
    EXPECT_EQ(Match(devices_[0].path, devices_[1].path)[1].problem,
              "wanted 1920x1080; control zoom is not there");
}

TEST_F(CameraMatchTest, ACameraOfLibcameraIsNotLookedFor) {
    RigConfig rig = Rig(devices_[0].path, "/base/soc/i2c0mux/imx219");
    rig.units[algo::Unit::kTrailer].cameras[0].source = CameraConfig::Source::kLibcamera;
    EXPECT_EQ(WishesOf(rig).size(), 1U);
    const auto matches = MatchCameras(rig, devices_);
    EXPECT_TRUE(matches[0].looked_for);
    EXPECT_FALSE(matches[1].looked_for);
    EXPECT_TRUE(AllThere(matches));
    EXPECT_THAT(MatchTable(matches), HasSubstr("rear    not checked"));
}

TEST_F(CameraMatchTest, ADeviceInUseIsThere) {
    devices_[1].state = CameraDevice::State::kBusy;
    EXPECT_TRUE(AllThere(Match(devices_[0].path, devices_[1].path)));
}

TEST_F(CameraMatchTest, ADeviceIsAskedForWhatTheRigFileSays) {
    RigConfig rig = Rig("/dev/video0", "/dev/video1");
    rig.period = std::chrono::milliseconds(40);
    rig.units[algo::Unit::kTrailer].cameras[0].live.size_px = {640, 480};
    rig.units[algo::Unit::kTrailer].cameras[0].live.format = "yuyv";
    const auto wishes = WishesOf(rig);
    ASSERT_EQ(wishes.size(), 2U);
    EXPECT_EQ(wishes[1].live.device, "/dev/video1");
    EXPECT_EQ(SizeText(wishes[1].live.size_px), "640x480");
    EXPECT_EQ(wishes[1].live.format, "yuyv");
    EXPECT_DOUBLE_EQ(wishes[1].rate_hz, 25);
}

TEST_F(CameraMatchTest, RecordedCamerasAreNotLookedFor) {
    RigConfig rig = Rig("/dev/video0", "/dev/video1");
    for (const algo::Unit unit : algo::kUnits)
        rig.units[unit].cameras[0].source = CameraConfig::Source::kReplay;
    EXPECT_TRUE(WishesOf(rig).empty());
    EXPECT_TRUE(MatchCameras(rig, devices_).empty());
}

}  // namespace
}  // namespace hitchview::app
