#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "tests/support/temporary_folder.hpp"

// `hitchview bench` from the outside: what it tells, never how fast it was.
namespace hitchview::app {
namespace {

using nlohmann::json;

class BenchTest : public testing::Test {
 protected:
    json Figures(std::vector<std::string> more) {
        std::vector<std::string> arguments{
            "bench", "--frames", "10", "--camera-width", "320",        "--canvas-width",
            "1024",  "--rounds", "1",  "--json",         folder_ / "x"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(RunProgram(HITCHVIEW, arguments), 0);
        std::ifstream file(folder_ / "x");
        return json::parse(file);
    }

    tests::TemporaryFolder folder_;
};

TEST_F(BenchTest, ItTellsWhatScriptsRelyOn) {
    const json figures = Figures({});
    for (const char* key : {"core_ms_without_jpeg", "jpeg_ms", "p50_ms", "p99_ms", "memcpy_ratio",
                            "render_to_remap_ratio"}) {
        ASSERT_TRUE(figures["whole_frame"].contains(key)) << key;
        EXPECT_GT(figures["whole_frame"][key].get<double>(), 0) << key;
    }
    for (const char* stage : {"motion", "map", "bands", "render", "total"}) {
        ASSERT_TRUE(figures["stages"].contains(stage)) << stage;
        EXPECT_GT(figures["stages"][stage]["memcpy_ratio"].get<double>(), 0) << stage;
    }
    // Pictures of eight cameras of two bytes to a pixel, and the panorama.
    EXPECT_EQ(figures["whole_frame"]["memcpy_bytes"], 8 * 320 * 180 * 2 + 1024 * 180 * 3 / 2);
    EXPECT_GT(figures["memory_bytes"]["all"].get<double>(), 8.0 * 320 * 180 * 2);
    EXPECT_GE(figures["scaling"].size(), 8U + 2U + 1U) << "cameras, widths, workers";
    EXPECT_EQ(figures["scaling"][0]["cameras"], 1);
}

TEST_F(BenchTest, InAHurryItLeavesOutTheScaling) {
    for (const char* format : {"nv12", "yuyv"}) {
        const json figures = Figures({"--quick", "--format", format});
        EXPECT_TRUE(figures["scaling"].empty());
        EXPECT_GT(figures["whole_frame"]["core_ms_without_jpeg"].get<double>(), 0) << format;
    }
}

TEST_F(BenchTest, WhatCannotBeMeasuredIsWrongUse) {
    EXPECT_EQ(RunProgram(HITCHVIEW, {"bench", "--canvas-width", "1000"}), 2);
    EXPECT_EQ(RunProgram(HITCHVIEW, {"bench", "--format", "mjpeg"}), 2);
    EXPECT_EQ(RunProgram(HITCHVIEW, {"bench", "--workers", "0"}), 2);
}

}  // namespace
}  // namespace hitchview::app
