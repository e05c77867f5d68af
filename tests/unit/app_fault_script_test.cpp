#include "app/fault_script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hitchview::app {
namespace {

using testing::HasSubstr;

hal::Checked<FaultScript> Parse(const std::string& text) {
    return ParseFaultScript({"faults.yaml", text});
}

TEST(FaultScriptTest, EachCameraHasItsFaults) {
    const auto script = Parse(
        "schema: 1\nscenario: snow\nframes: 90\nfaults:\n"
        "  - {camera: left, does: frozen, from: 10, until: 20}\n"
        "  - {camera: [left, rear], does: dead, from: 30}\n"
        "  - {camera: all, does: black, until: 5}\n");
    ASSERT_TRUE(script) << script.error();
    EXPECT_EQ(script.value().scenario, "snow");
    EXPECT_EQ(script.value().frames, 90);
    const auto left = script.value().Of("left");
    ASSERT_EQ(left.size(), 3U);
    EXPECT_EQ(left[0].does, FaultKind::kFrozen);
    EXPECT_FALSE(left[0].Befalls(9));
    EXPECT_TRUE(left[0].Befalls(10));
    EXPECT_TRUE(left[0].Befalls(19));
    EXPECT_FALSE(left[0].Befalls(20));
    EXPECT_TRUE(left[1].Befalls(1'000'000));
    EXPECT_TRUE(left[2].Befalls(0));
    EXPECT_EQ(script.value().Of("rear").size(), 2U);
    EXPECT_EQ(script.value().Of("front").size(), 1U);
}

TEST(FaultScriptTest, EveryKindHasAWordThatReadsBack) {
    for (const FaultKind kind : kFaultKinds) {
        const auto script = Parse(std::string("schema: 1\nfaults: [{camera: a, does: ") +
                                  ToString(kind) + "}]\n");
        ASSERT_TRUE(script) << script.error();
        EXPECT_EQ(script.value().faults[0].fault.does, kind);
    }
}

TEST(FaultScriptTest, MistakesAreNamedWithTheirLines) {
    const auto script = Parse(
        "schema: 1\nfaults:\n"
        "  - {camera: left, does: melted, from: 10}\n"
        "  - {camera: left, does: dead, from: 20, until: 20}\n"
        "  - {does: dead, from: -1}\n"
        "  - {camera: left, does: dead, til: 3}\n");
    ASSERT_FALSE(script);
    EXPECT_THAT(script.error(), HasSubstr("faults.yaml:3: faults[0].does is melted"));
    EXPECT_THAT(script.error(), HasSubstr("faults.yaml:4: faults[1].until is 20, must be greater"));
    EXPECT_THAT(script.error(), HasSubstr("faults.yaml:5: faults[2].camera"));
    EXPECT_THAT(script.error(), HasSubstr("faults.yaml:5: faults[2].from is -1"));
    EXPECT_THAT(script.error(), HasSubstr("faults.yaml:6: faults[3].til"));
}

TEST(FaultScriptTest, ACameraThatTheRigDoesNotHaveIsRefused) {
    RigConfig rig;
    rig.file = "rig.yaml";
    rig.units[algo::Unit::kTractor].cameras = {{.name = "left"}, {.name = "right"}};
    EXPECT_TRUE(CheckCameras(
        Parse("schema: 1\nfaults: [{camera: [left, right], does: dead}, {camera: all, does: dead}]\n")
            .value(),
        rig));
    const auto checked =
        CheckCameras(Parse("schema: 1\nfaults: [{camera: rear, does: dead}]\n").value(), rig);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error(),
              "faults.yaml: faults[0].camera is rear, must be all or of rig.yaml: left right");
}

}  // namespace
}  // namespace hitchview::app
