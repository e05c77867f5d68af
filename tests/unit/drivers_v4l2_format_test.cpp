#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <vector>

#include "drivers/v4l2_controls.hpp"
#include "drivers/v4l2_format.hpp"
#include "drivers/v4l2_offers.hpp"
#include "drivers/v4l2_probe.hpp"

namespace hitchview::drivers {
namespace {

using Bytes = std::vector<std::uint8_t>;

V4l2Layout Layout(std::uint32_t fourcc, int line_bytes) {
    V4l2Layout layout;
    layout.fourcc = fourcc;
    layout.width_px = 16;
    layout.height_px = 8;
    layout.planes.fill({line_bytes, 0});
    return layout;
}

TEST(V4l2FormatTest, ChromaOfNv12FollowsThePaddedLuma) {
    const Bytes bytes(32 * 8 + 32 * 4);
    const auto maybe_planes = PlanesOf(Layout(V4L2_PIX_FMT_NV12, 32), {bytes, {}, {}});
    ASSERT_TRUE(maybe_planes);
    EXPECT_EQ((*maybe_planes)[0].data, bytes.data());
    EXPECT_EQ((*maybe_planes)[1].data, bytes.data() + 256);
    EXPECT_EQ((*maybe_planes)[1].stride_bytes, 32);
    EXPECT_EQ((*maybe_planes)[2].data, nullptr);
}

TEST(V4l2FormatTest, ChromaMayLieInMemoryOfItsOwn) {
    const Bytes luma(16 * 8);
    const Bytes chroma(20 * 4);
    V4l2Layout layout = Layout(V4L2_PIX_FMT_NV12M, 16);
    layout.planes[1].line_bytes = 20;
    const auto maybe_planes = PlanesOf(layout, {luma, chroma, {}});
    ASSERT_TRUE(maybe_planes);
    EXPECT_EQ((*maybe_planes)[1].data, chroma.data());
    EXPECT_EQ((*maybe_planes)[1].stride_bytes, 20);
}

TEST(V4l2FormatTest, AFrameThatIsCutShortHasNoPlanes) {
    const std::size_t needed = 40 * 7 + 32;  // the last line may lack its padding
    const V4l2Layout layout = Layout(V4L2_PIX_FMT_UYVY, 40);
    EXPECT_TRUE(PlanesOf(layout, {Bytes(needed), {}, {}}));
    EXPECT_FALSE(PlanesOf(layout, {Bytes(needed - 1), {}, {}}));
    EXPECT_FALSE(PlanesOf(Layout(V4L2_PIX_FMT_NV12, 16), {Bytes(16 * 12 - 1), {}, {}}));
    EXPECT_FALSE(PlanesOf(Layout(V4L2_PIX_FMT_NV12M, 16), {Bytes(128), Bytes(63), {}}));
    EXPECT_FALSE(PlanesOf(layout, {}));
}

TEST(V4l2FormatTest, RangeFollowsTheDriverAndElseTheKernelsRule) {
    const auto range = [](std::uint32_t fourcc, std::uint32_t quantization, std::uint32_t colours) {
        return RangeOf(fourcc, quantization, colours);
    };
    EXPECT_EQ(range(V4L2_PIX_FMT_UYVY, V4L2_QUANTIZATION_FULL_RANGE, V4L2_COLORSPACE_SRGB),
              hal::Range::kFull);
    EXPECT_EQ(range(V4L2_PIX_FMT_UYVY, V4L2_QUANTIZATION_DEFAULT, V4L2_COLORSPACE_SRGB),
              hal::Range::kLimited);
    EXPECT_EQ(range(V4L2_PIX_FMT_UYVY, V4L2_QUANTIZATION_DEFAULT, V4L2_COLORSPACE_JPEG),
              hal::Range::kFull);
    EXPECT_EQ(range(V4L2_PIX_FMT_GREY, V4L2_QUANTIZATION_DEFAULT, V4L2_COLORSPACE_SRGB),
              hal::Range::kFull);
    EXPECT_EQ(range(V4L2_PIX_FMT_GREY, V4L2_QUANTIZATION_LIM_RANGE, V4L2_COLORSPACE_JPEG),
              hal::Range::kLimited);
}

V4l2FormatOffer Offer(std::uint32_t fourcc, int width, int height, std::vector<double> rates_hz) {
    V4l2Sizes sizes{width, width, 1, height, height, 1, {}};
    for (const double rate : rates_hz) sizes.rates.push_back({rate, rate});
    return {fourcc, "", {sizes}};
}

class V4l2ChoiceTest : public testing::Test {
 protected:
    std::string Chosen(const std::string& format, double rate_hz = 30) {
        const auto chosen = ChooseFormat(offers_, {{1280, 720}, rate_hz, format});
        return chosen ? chosen.value()->name : chosen.error();
    }

    std::vector<V4l2FormatOffer> offers_{Offer(V4L2_PIX_FMT_MJPEG, 1280, 720, {30}),
                                         Offer(V4L2_PIX_FMT_YUYV, 1280, 720, {10, 29.97})};
};

TEST_F(V4l2ChoiceTest, BestIsTheFirstInOurOrderNotTheDevices) {
    EXPECT_EQ(Chosen("best"), "yuyv");
    offers_.push_back(Offer(V4L2_PIX_FMT_NV12, 1280, 720, {30}));
    EXPECT_EQ(Chosen("best"), "nv12");
    EXPECT_EQ(Chosen("mjpeg"), "mjpeg");
}

TEST_F(V4l2ChoiceTest, WhatIsTooSlowOrOfAnotherSizeIsNotOffered) {
    offers_[1] = Offer(V4L2_PIX_FMT_YUYV, 1280, 720, {10});
    EXPECT_EQ(Chosen("best"), "mjpeg");
    EXPECT_EQ(Chosen("yuyv"),
              "wanted 1280x720 at 30 Hz as yuyv; offered: MJPG 1280x720 at 30 Hz; YUYV 1280x720 at "
              "10 Hz");
}

TEST_F(V4l2ChoiceTest, ARangeOfSizesHasItsSteps) {
    V4l2Sizes range{16, 1920, 64, 16, 1080, 2, {{1, 60}}};
    offers_ = {{V4L2_PIX_FMT_UYVY, "", {range}}};
    EXPECT_EQ(Chosen("best"),
              "wanted 1280x720 at 30 Hz as best; offered: UYVY 16x16..1920x1080 at "
              "1..60 Hz");
    offers_[0].sizes[0].step_width_px = 16;
    EXPECT_EQ(Chosen("best"), "uyvy");
}

TEST_F(V4l2ChoiceTest, WhereADeviceListsNothingTheRequestIsTried) {
    offers_ = {{V4L2_PIX_FMT_UYVY, "", {}}};
    EXPECT_EQ(Chosen("best"), "uyvy");
}

TEST_F(V4l2ChoiceTest, AnUnknownNameIsRefusedWithTheKnownOnes) {
    EXPECT_EQ(Chosen("rgb"),
              "format is rgb, must be one of best, nv12, nm12, uyvy, yuyv, mjpeg, jpeg, grey");
}

class V4l2ControlsTest : public testing::Test {
 protected:
    /// Value of the single control planned, or the error.
    std::string Plan(const std::string& control, const std::string& value) {
        const auto planned = PlanControls(controls_, {{control, value}});
        return planned ? std::to_string(planned.value().at(0).value) : planned.error();
    }

    std::vector<V4l2Control> controls_{
        {V4L2_CID_EXPOSURE_AUTO,
         "auto_exposure",
         V4L2_CTRL_TYPE_MENU,
         0,
         3,
         1,
         3,
         0,
         {{1, "Manual Mode"}, {3, "Aperture Priority Mode"}}},
        {V4L2_CID_EXPOSURE_ABSOLUTE,
         "exposure_time_absolute",
         V4L2_CTRL_TYPE_INTEGER,
         3,
         2047,
         4,
         250,
         0,
         {}},
        {V4L2_CID_BACKLIGHT_COMPENSATION,
         "backlight_compensation",
         V4L2_CTRL_TYPE_BOOLEAN,
         0,
         1,
         1,
         0,
         0,
         {}},
        {V4L2_CID_GAIN, "gain", V4L2_CTRL_TYPE_INTEGER, 0, 9, 1, 0, V4L2_CTRL_FLAG_READ_ONLY, {}},
    };
};

TEST_F(V4l2ControlsTest, NamesIdsMenusAndSwitchesAreUnderstood) {
    EXPECT_EQ(Plan("exposure_time_absolute", "7"), "7");
    EXPECT_EQ(Plan("Exposure Time, Absolute", "0x0b"), "11");
    EXPECT_EQ(Plan("0x009a0902", "2047"), "2047");
    EXPECT_EQ(Plan("auto_exposure", "manual mode"), "1");
    EXPECT_EQ(Plan("auto_exposure", "3"), "3");
    EXPECT_EQ(Plan("backlight_compensation", "true"), "1");
}

TEST_F(V4l2ControlsTest, ErrorsNameControlValueAndRange) {
    EXPECT_EQ(Plan("exposure_time_absolute", "2"),
              "control exposure_time_absolute is 2, must be 3 to 2047 in steps of 4");
    EXPECT_EQ(Plan("exposure_time_absolute", "8"),
              "control exposure_time_absolute is 8, must be 3 to 2047 in steps of 4");
    EXPECT_EQ(Plan("exposure_time_absolute", "fast"),
              "control exposure_time_absolute is fast, must be 3 to 2047 in steps of 4");
    EXPECT_EQ(Plan("auto_exposure", "2"),
              "control auto_exposure is 2, must be one of 1 (Manual Mode), 3 (Aperture Priority "
              "Mode)");
    EXPECT_NE(Plan("gain", "1").find("control gain cannot be set to 1"), std::string::npos);
    EXPECT_EQ(Plan("zoom", "1"),
              "control zoom is not there; the device has auto_exposure, exposure_time_absolute, "
              "backlight_compensation, gain");
}

TEST_F(V4l2ControlsTest, TurningOverIsBothMirrorsAndAFlipUndoesOne) {
    controls_.push_back(
        {V4L2_CID_HFLIP, "horizontal_flip", V4L2_CTRL_TYPE_BOOLEAN, 0, 1, 1, 0, 0, {}});
    controls_.push_back(
        {V4L2_CID_VFLIP, "vertical_flip", V4L2_CTRL_TYPE_BOOLEAN, 0, 1, 1, 0, 0, {}});
    const auto turned = PlanOrientation(controls_, {180, true, false});
    ASSERT_TRUE(turned.ok());
    ASSERT_EQ(turned.value().size(), 2U);
    EXPECT_EQ(turned.value()[0].value, 0);
    EXPECT_EQ(turned.value()[1].value, 1);
}

TEST_F(V4l2ControlsTest, ADeviceWithoutMirrorsSendsTheUserToTheCalibration) {
    EXPECT_TRUE(PlanOrientation(controls_, {}).ok());
    const auto turned = PlanOrientation(controls_, {180, false, false});
    ASSERT_FALSE(turned.ok());
    EXPECT_NE(turned.error().find("calibrate the camera as it is mounted"), std::string::npos);
}

TEST_F(V4l2ControlsTest, WhatCannotBeSetIsToldBeforeItIsTried) {
    V4l2DeviceReport report;
    report.controls = controls_;
    report.inputs = {"Camera", "HDMI"};
    V4l2CameraOptions options;
    options.controls = {{"backlight_compensation", "true"}};
    options.input = 1;
    EXPECT_TRUE(CheckSettings(report, options).ok());
    options.input = 2;
    EXPECT_EQ(CheckSettings(report, options).error(),
              "input 2 is not there; the device has 0 (Camera), 1 (HDMI)");
    options.input = -1;
    options.controls[0].value = "2";
    EXPECT_EQ(CheckSettings(report, options).error(),
              "control backlight_compensation is 2, must be 0 to 1");
    options.controls.clear();
    options.orientation.vertical_flip = true;
    EXPECT_NE(CheckSettings(report, options).error().find("cannot mirror the picture vertically"),
              std::string::npos);
}

}  // namespace
}  // namespace hitchview::drivers
