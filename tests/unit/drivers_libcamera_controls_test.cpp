#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libcamera/control_ids.h>

#include "drivers/libcamera_controls.hpp"

namespace hitchview::drivers {
namespace {

namespace controls = libcamera::controls;
using libcamera::ControlInfo;
using libcamera::ControlValue;
using testing::HasSubstr;

class LibcameraControlsTest : public testing::Test {
 protected:
    std::string Refusal(const std::string& control, const std::string& value) {
        const auto planned = PlanLibcameraControls(map_, {{control, value}});
        return planned ? "" : planned.error();
    }

    libcamera::ControlInfoMap map_{
        {{&controls::Brightness, ControlInfo(-1.0F, 1.0F)},
         {&controls::AeEnable, ControlInfo(false, true)},
         {&controls::ExposureTime, ControlInfo(std::int32_t{100}, std::int32_t{60000})},
         {&controls::ColourGains, ControlInfo(0.0F, 32.0F)},
         {&controls::FrameDurationLimits, ControlInfo(std::int64_t{16666}, std::int64_t{1000000})}},
        controls::controls};
};

TEST_F(LibcameraControlsTest, ValuesTakeTheTypeOfTheirControl) {
    const auto planned = PlanLibcameraControls(map_, {{"brightness", "-0.5"},
                                                      {"AeEnable", "false"},
                                                      {"ExposureTime", "8000"},
                                                      {"ColourGains", "1.5, 2"}});
    ASSERT_TRUE(planned.ok()) << planned.error();
    const libcamera::ControlList& list = planned.value();
    EXPECT_EQ(*list.get(controls::Brightness), -0.5F);
    EXPECT_EQ(*list.get(controls::AeEnable), false);
    EXPECT_EQ(*list.get(controls::ExposureTime), 8000);
    EXPECT_EQ((*list.get(controls::ColourGains))[1], 2.0F);
}

TEST_F(LibcameraControlsTest, WhatCannotBeSetIsNamedWithWhatCan) {
    EXPECT_THAT(Refusal("Focus", "1"),
                HasSubstr("control Focus is not one of this camera: it has AeEnable, Brightness, "
                          "ColourGains, ExposureTime, FrameDurationLimits"));
    EXPECT_THAT(Refusal("ExposureTime", "99"), HasSubstr("is 99, must be [100..60000]"));
    EXPECT_THAT(Refusal("ExposureTime", "200.5"), HasSubstr("must be [100..60000]"));
    EXPECT_THAT(Refusal("ExposureTime", "99999999999"), HasSubstr("must be [100..60000]"));
    EXPECT_THAT(Refusal("Brightness", "bright"), HasSubstr("is bright, must be a number"));
    EXPECT_THAT(Refusal("Brightness", ""), HasSubstr("must be a number"));
    EXPECT_THAT(Refusal("AeEnable", "2"), HasSubstr("is 2, must be"));
    EXPECT_THAT(Refusal("ColourGains", "1.5"), HasSubstr("must be 2 numbers"));
    EXPECT_THAT(Refusal("ColourGains", "1.5 33"), HasSubstr("is 1.5 33, must be"));
}

TEST_F(LibcameraControlsTest, TheRateIsTheDurationOfAFrameUnlessGiven) {
    auto planned = PlanLibcameraControls(map_, {});
    ASSERT_TRUE(PlanLibcameraRate(map_, 30, planned.value()).ok());
    EXPECT_EQ((*planned.value().get(controls::FrameDurationLimits))[1], 33333);
    auto given = PlanLibcameraControls(map_, {{"FrameDurationLimits", "40000 50000"}});
    ASSERT_TRUE(PlanLibcameraRate(map_, 30, given.value()).ok());
    EXPECT_EQ((*given.value().get(controls::FrameDurationLimits))[1], 50000);
    const auto fast = PlanLibcameraRate(map_, 120, PlanLibcameraControls(map_, {}).value());
    ASSERT_FALSE(fast.ok());
    EXPECT_THAT(fast.error(), HasSubstr("must be [16666..1000000]"));
}

TEST_F(LibcameraControlsTest, ACameraWithoutARateIsLeftAlone) {
    const libcamera::ControlInfoMap none;
    libcamera::ControlList planned;
    EXPECT_TRUE(PlanLibcameraRate(none, 30, planned).ok());
    EXPECT_TRUE(planned.empty());
}

}  // namespace
}  // namespace hitchview::drivers
