#include <gtest/gtest.h>

#include "app/heap_calls.hpp"
#include "app/report.hpp"
#include "app/run_loop.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/simulated_rig_files.hpp"

// A stage that takes memory is found out. This executable has app/heap_interposer.cpp among its
// sources, as the program has.
namespace hitchview::app {
namespace {

constexpr int kFrames = 6;

class HiddenAllocationTest : public testing::Test {
 protected:
    HiddenAllocationTest() { tests::WriteSimulatedCalibration(folder_, 320, 180); }
    void SetUp() override {
        if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    }

    /// A short drive; `sabotage` is called with each panorama, as a stage of the loop would be.
    void Drive(const RunOptions& options, const ShownHook& sabotage) {
        const std::string rig = folder_.Write(
            "rig.yaml",
            "schema: 1\ncanvas: {projection: cylinder, size_px: [1024, 180]}\n"
            "calibration: rig.calib.yaml\n" +
                tests::SimulatedUnits([](const std::string&) { return "{simulated: true}"; }) +
                "simulation: {camera_size_px: [320, 180], frames: " + std::to_string(kFrames) +
                "}\n");
        const std::atomic<bool> stop{false};
        auto summary = RunRig(LoadRigConfig(rig).value(), options, stop, sabotage);
        ASSERT_TRUE(summary) << summary.error();
        memory_ = summary->memory;
    }

    tests::TemporaryFolder folder_;
    MemorySummary memory_;
};

/// Memory that is taken and given back at once: no leak, nothing in the RSS.
void TakeMemory() {
    std::unique_ptr<char[]> memory(new char[64]);
    asm volatile("" ::"r"(memory.get()) : "memory");
}

TEST_F(HiddenAllocationTest, WithoutOneNothingIsCounted) {
    Drive({}, [](const ShownPanorama&, const Pipeline&) {});
    EXPECT_EQ(memory_.heap_calls.value().frame_path, 0U);
}

TEST_F(HiddenAllocationTest, OneForEachPanoramaIsCounted) {
    Drive({}, [](const ShownPanorama&, const Pipeline&) { TakeMemory(); });
    EXPECT_EQ(memory_.heap_calls.value().frame_path, kFrames);
    ASSERT_EQ(memory_.heap_calls->threads.size(), 1U);
}

using HiddenAllocationDeathTest = HiddenAllocationTest;

TEST_F(HiddenAllocationDeathTest, TheTrapStopsTheRunAndNamesThreadAndCaller) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto late = [](const ShownPanorama& shown, const Pipeline&) {
        if (shown.picture.header.sequence == 3) TakeMemory();
    };
    EXPECT_DEATH(Drive({.trap_alloc = true}, late),
                 "heap call after READY on thread 'hidden_allocati', called from:");
}

}  // namespace
}  // namespace hitchview::app
