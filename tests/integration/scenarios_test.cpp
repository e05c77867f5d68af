#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "tests/support/temporary_folder.hpp"

// `hitchview scenarios` from the outside, on drives too short to say anything of quality.
namespace hitchview::app {
namespace {

using nlohmann::json;

class ScenariosTest : public testing::Test {
 protected:
    /// Figures of a few small frames of the straight drive.
    json Drive(std::vector<std::string> more) {
        std::vector<std::string> arguments{
            "scenarios", "straight",       "--frames", "12",      "--camera-width",
            "320",       "--canvas-width", "1024",     "--cache", folder_ / "cache",
            "--json",    folder_ / "x"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(RunProgram(HITCHVIEW, arguments), 0);
        std::ifstream file(folder_ / "x");
        return json::parse(file);
    }

    tests::TemporaryFolder folder_;
};

TEST_F(ScenariosTest, EachLookaheadAndThePapersFormAreDrivenBesideEachOther) {
    const json figures = Drive({"--lookahead", "0,2", "--offline"});
    ASSERT_EQ(figures.size(), 3U);
    for (const char* drive : {"straight", "straight+2", "straight+all"}) {
        ASSERT_TRUE(figures.contains(drive)) << drive;
        EXPECT_EQ(figures[drive]["frames"], 12) << drive;
        EXPECT_EQ(figures[drive]["warp"]["tractor"]["folded_cells"], 0) << drive;
    }
    EXPECT_EQ(figures["straight"]["lookahead_frames"], 0);
    EXPECT_EQ(figures["straight+2"]["lookahead_frames"], 2);
    EXPECT_TRUE(figures["straight+all"]["lookahead_frames"].is_null());
    EXPECT_EQ(figures["straight+all"]["offline"], true);
    EXPECT_NE(figures["straight"]["warp"], figures["straight+2"]["warp"]);
    EXPECT_NE(figures["straight"]["warp"], figures["straight+all"]["warp"]);
}

TEST_F(ScenariosTest, WithoutMoreOnlyTheLiveFormWithoutLookaheadIsDriven) {
    const json figures = Drive({});
    ASSERT_EQ(figures.size(), 1U);
    EXPECT_EQ(figures["straight"]["offline"], false);
}

TEST_F(ScenariosTest, ALookaheadOutOfRangeIsWrongUse) {
    EXPECT_EQ(RunProgram(HITCHVIEW, {"scenarios", "straight", "--lookahead", "0,11"}), 2);
}

}  // namespace
}  // namespace hitchview::app
