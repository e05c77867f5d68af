#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "app/camera_table.hpp"

namespace hitchview::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kLongName =
    "/dev/v4l/by-path/platform-fd500000.pcie-pci-0000:01:00.0-platform-xhci-hcd.2.auto-usb-0:1.4.2."
    "1:1.0-video-index0";

OfferedSizes Fixed(int width_px, int height_px, const std::vector<double>& rates_hz) {
    OfferedSizes sizes{{width_px, height_px}, {width_px, height_px}, {}};
    for (const double rate_hz : rates_hz) sizes.rates.push_back({rate_hz, rate_hz});
    return sizes;
}

/// Offers two formats alike, another one in fewer sizes, and one that nobody here takes.
CameraDevice Camera() {
    const std::vector<OfferedSizes> sizes{Fixed(640, 480, {15, 30, 60, 120}),
                                          Fixed(1280, 720, {30, 29.97}), Fixed(1920, 1080, {30}),
                                          Fixed(3840, 2160, {15})};
    CameraDevice device;
    device.path = "/dev/video4";
    device.names = {kLongName};
    device.driver = "uvcvideo";
    device.card = "Road Camera";
    device.bus = "usb-0000:01:00.0-1.4.2.1";
    device.stamps = CameraDevice::Stamps::kStartOfExposure;
    device.formats = {{"UYVY", "uyvy", "UYVY 4:2:2", sizes},
                      {"YUYV", "yuyv", "YUYV 4:2:2", sizes},
                      {"GREY", "grey", "8-bit", {{{16, 16}, {4096, 4096}, {{1, 90}}}}},
                      {"RGB3", "", "24-bit RGB", {}}};
    device.pick = CameraPick{"uyvy", {1280, 720}, 30, false, {"yuyv", "grey"}};
    return device;
}

CameraDevice Refused(CameraDevice::State state, const std::string& refusal) {
    CameraDevice device;
    device.path = "/dev/video11";
    device.state = state;
    device.refusal = refusal;
    return device;
}

std::vector<std::string> Lines(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

TEST(CameraTableTest, ShowsARowWithItsDetailsBelow) {
    EXPECT_EQ(CameraTable({Camera()}, CameraDetail::kBest),
              "DEVICE       DRIVER    CARD         STATE  TIME STAMPS        PICK\n"
              "/dev/video4  uvcvideo  Road Camera  free   start of exposure  uyvy 1280x720 at 30 "
              "Hz\n"
              "  name    " +
                  kLongName +
                  "\n"
                  "  bus     usb-0000:01:00.0-1.4.2.1\n"
                  "  offers  UYVY, YUYV: 1280x720 at 30, 29.97 Hz; 3840x2160 at 15 Hz; 1920x1080 "
                  "at 30 Hz; and 1 more\n"
                  "  offers  GREY: 16x16..4096x4096 at 1..90 Hz\n"
                  "  why     2 bytes a pixel, as they come; would do too: yuyv, grey\n");
}

TEST(CameraTableTest, ShowsEverythingWhereAsked) {
    const std::string table = CameraTable({Camera()}, CameraDetail::kAll);
    EXPECT_THAT(table, AllOf(HasSubstr("640x480 at\n          120, 60, 30, 15 Hz"),
                             HasSubstr("not taken here: RGB3"), Not(HasSubstr("more")),
                             Not(HasSubstr("..,"))));
}

TEST(CameraTableTest, OnlyALongNameIsLongerThanALine) {
    CameraDevice device = Camera();
    device.formats[0].sizes.resize(40, device.formats[0].sizes[0]);
    for (const std::string& line : Lines(CameraTable({device}, CameraDetail::kAll))) {
        if (line.find(kLongName) == line.npos) {
            EXPECT_LE(line.size(), 100U) << line;
        }
    }
}

TEST(CameraTableTest, ColumnsStandBelowEachOtherWhateverADeviceIsCalled) {
    CameraDevice long_card = Camera();
    long_card.path = "/dev/video10";
    long_card.card = "A camera of thirty-one letters.";
    const auto lines = Lines(CameraTable({Camera(), long_card}, CameraDetail::kBest));
    const std::size_t column = lines.front().find("STATE");
    int rows = 0;
    for (const std::string& line : lines) {
        if (!line.starts_with("/dev/")) continue;
        EXPECT_EQ(line.substr(column, 4), "free");
        ++rows;
    }
    EXPECT_EQ(rows, 2);
}

TEST(CameraTableTest, WhatATerminalWouldObeyIsNotPassedOn) {
    CameraDevice device = Camera();
    device.card = "\x1b[2JRoad\nCam\xc2\xae";
    device.names = {"/dev/v4l/by-id/\x1b]0;x\x07"};
    const std::string table = CameraTable({device}, CameraDetail::kBest);
    EXPECT_THAT(table, AllOf(HasSubstr("?[2JRoad?Cam??"), HasSubstr("by-id/?]0;x?"),
                             Not(HasSubstr("\x1b")), Not(HasSubstr("\x07"))));
}

TEST(CameraTableTest, ARefusedDeviceComesWithTheRemedy) {
    const std::string forbidden = CameraTable(
        {Refused(CameraDevice::State::kForbidden, "open: Permission denied")}, CameraDetail::kBest);
    EXPECT_THAT(forbidden,
                AllOf(HasSubstr("forbidden"), HasSubstr("open: Permission denied"),
                      HasSubstr("add the user to group video"), Not(HasSubstr("offers"))));
    const std::string refused = CameraTable(
        {Refused(CameraDevice::State::kRefused, "open: Input/output error")}, CameraDetail::kBest);
    EXPECT_THAT(refused, AllOf(HasSubstr("refused"), HasSubstr("open: Input/output error"),
                               Not(HasSubstr("group video"))));
}

TEST(CameraTableTest, ADeviceInUseIsTold) {
    CameraDevice device = Camera();
    device.state = CameraDevice::State::kBusy;
    device.stamps = CameraDevice::Stamps::kUnknown;
    EXPECT_THAT(CameraTable({device}, CameraDetail::kBest),
                AllOf(HasSubstr("  busy   unknown"), HasSubstr("offers")));
}

TEST(CameraTableTest, ADeviceThatCannotDoSaysWhatWasWanted) {
    CameraDevice device = Camera();
    device.pick.reset();
    device.no_pick = "wanted 64x64 at 30 Hz as best, which it does not offer";
    EXPECT_THAT(
        CameraTable({device}, CameraDetail::kBest),
        AllOf(HasSubstr("  none\n"),
              HasSubstr("why     wanted 64x64 at 30 Hz as best, which it does not offer; --all ")));
}

TEST(CameraTableTest, AFormatThatTheRigFileNamesIsNotOurChoice) {
    CameraDevice device = Camera();
    device.pick->by_name = true;
    EXPECT_THAT(CameraTable({device}, CameraDetail::kBest),
                HasSubstr("why     the rig file says so"));
}

TEST(CameraTableTest, ShowsTheSpeedWhereItWasMeasured) {
    CameraDevice device = Camera();
    EXPECT_THAT(CameraTable({device}, CameraDetail::kBest), Not(HasSubstr("speed")));
    device.speed = ReadSpeed{0.05, 12.25};
    EXPECT_THAT(CameraTable({device}, CameraDetail::kBest),
                HasSubstr("speed   0.05 GB/s from a buffer, 12.2 GB/s from ordinary memory\n"));
}

TEST(CameraTableTest, WithoutAnyCameraSaysWhatToCheck) {
    EXPECT_THAT(CameraTable({}, CameraDetail::kBest),
                AllOf(HasSubstr("No camera"), HasSubstr("plugged in"), HasSubstr("driver")));
}

TEST(CameraTableTest, NamesTheCameraThatIsMissing) {
    const std::string table =
        MatchTable({{algo::Unit::kTractor, "front", kLongName, "/dev/video4", ""},
                    {algo::Unit::kTrailer, "rear", "/dev/video9", "", "nothing is there"},
                    {algo::Unit::kTrailer, "left", "/dev/video5", "/dev/video5", "wanted nv12"}});
    EXPECT_EQ(table,
              "UNIT     CAMERA  STATE     DEVICE\n"
              "tractor  front   there     /dev/video4\n"
              "  name    " +
                  kLongName +
                  "\n"
                  "trailer  rear    MISSING   none\n"
                  "  name    /dev/video9\n"
                  "  why     nothing is there\n"
                  "trailer  left    UNUSABLE  /dev/video5\n"
                  "  name    /dev/video5\n"
                  "  why     wanted nv12\n");
}

TEST(CameraJsonTest, HoldsEverything) {
    const auto json = CamerasJson({Camera()})[0];
    EXPECT_EQ(json.at("device"), "/dev/video4");
    EXPECT_EQ(json.at("names")[0], kLongName);
    EXPECT_EQ(json.at("state"), "free");
    EXPECT_EQ(json.at("time_stamps"), "start of exposure");
    EXPECT_EQ(json.at("formats").size(), 4U);
    EXPECT_EQ(json.at("formats")[0].at("sizes").size(), 4U);
    EXPECT_EQ(json.at("formats")[0].at("sizes")[0].at("rates").size(), 4U);
    EXPECT_EQ(json.at("formats")[2].at("sizes")[0].at("rates")[0].at("fastest_hz"), 90);
    EXPECT_TRUE(json.at("formats")[3].at("format").is_null());
    EXPECT_EQ(json.at("pick").at("format"), "uyvy");
    EXPECT_EQ(json.at("pick").at("size_px"), (std::vector<int>{1280, 720}));
    EXPECT_TRUE(json.at("read_speed").is_null());
}

TEST(CameraJsonTest, TextThatIsNotUtf8IsMadeSo) {
    CameraDevice device = Camera();
    device.card = "Cam\xc2\xae \"\x1b\xc2";  // cut off within a character
    const auto json = CamerasJson({device});
    EXPECT_EQ(nlohmann::json::parse(json.dump())[0].at("card"), "Cam\u00ae \"\x1b\ufffd");
}

TEST(CameraJsonTest, WithoutCamerasIsAnEmptyList) {
    EXPECT_EQ(CamerasJson({}).dump(), "[]");
    EXPECT_EQ(MatchesJson({}).dump(), "[]");
}

TEST(CameraJsonTest, ACameraThatIsMissingHasNoDevice) {
    const auto json =
        MatchesJson({{algo::Unit::kTrailer, "rear", "/dev/video9", "", "nothing is there"}});
    EXPECT_TRUE(json[0].at("device").is_null());
    EXPECT_EQ(json[0].at("problem"), "nothing is there");
}

}  // namespace
}  // namespace hitchview::app
