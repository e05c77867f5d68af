#include <gtest/gtest.h>
#include <sched.h>

#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/small_drive.hpp"

// The real-time contract of the program itself, publishing over LCM. Runs in a network namespace of
// its own (tests/support/lcm_namespace.sh).
namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr int kFrames = 160;
constexpr const char* kCanvas = "{projection: cylinder, size_px: [1024, 180]}";

class RealTimeRunTest : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<tests::TemporaryFolder>();
        tests::RecordSmallDrive(*folder_, 16, kFrames);
    }
    static void TearDownTestSuite() { folder_.reset(); }

    void SetUp() override {
        if (!tests::kHeapCallsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
    }

    /// report.json of a run with this verb and these options.
    static json Report(std::vector<std::string> arguments, const std::string& more = "") {
        const std::string can =
            std::string("can:\n  source: {simulated: true}\n") + tests::kSimulatedHitchAngle;
        const std::string rig = tests::SmallDriveRig(*folder_, kCanvas, can + more);
        arguments.insert(arguments.end(), {"--rig", rig, "--out", *folder_ / "out"});
        EXPECT_EQ(RunProgram(HITCHVIEW, arguments), 0);
        return json::parse(tests::FileText(*folder_ / "out/report.json"));
    }

    static std::unique_ptr<tests::TemporaryFolder> folder_;
};

std::unique_ptr<tests::TemporaryFolder> RealTimeRunTest::folder_;

std::int64_t GrownBytes(const json& report) {
    return report.at("rss_bytes").get<std::int64_t>() -
           report.at("rss_bytes_at_ready").get<std::int64_t>();
}

/// This process and those it starts, on one CPU until destroyed.
class OneCpu {
 public:
    OneCpu() {
        sched_getaffinity(0, sizeof before_, &before_);
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
        sched_setaffinity(0, sizeof one, &one);
    }
    ~OneCpu() { sched_setaffinity(0, sizeof before_, &before_); }
    OneCpu(const OneCpu&) = delete;
    OneCpu& operator=(const OneCpu&) = delete;

 private:
    cpu_set_t before_{};
};

TEST_F(RealTimeRunTest, NoThreadButThoseOfFilesTakesMemoryAfterReady) {
    const json report = Report({"replay", "--publish", "--write-video", "--trap-alloc"},
                               "publish:\n  viewports: [{name: rearward_mirror, azimuth_deg: [-150, 150]}]\n"
                               "  preview: {rate_hz: 5}\n");
    EXPECT_EQ(report.at("frames"), kFrames);
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0);
    EXPECT_TRUE(report.at("heap_calls_by_thread").empty());
    EXPECT_GT(report.at("heap_calls_files"), kFrames);  // decoders do: the counter was on
}

TEST_F(RealTimeRunTest, MemoryIsResidentFromReadyOn) {
    const json report = Report({"run", "--trap-alloc"});
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0);
    // Far fewer than one for each frame set: the decoders' first pictures.
    EXPECT_LT(report.at("minor_faults_after_ready"), kFrames / 2);
    EXPECT_EQ(report.at("major_faults_after_ready"), 0);
    EXPECT_LT(GrownBytes(report), 2'000'000);
}

TEST_F(RealTimeRunTest, TooLittleTimeDropsFrameSetsAndLatencyStays) {
    const OneCpu one_cpu;
    constexpr double kPeriod_ms = 4;  // eight pictures are decoded in it, no panorama is made
    const json report = Report({"run"}, "period_ms: 4\n");
    const int frames = report.at("frames");
    const int dropped = report.at("dropped");
    EXPECT_EQ(frames + dropped, kFrames);
    EXPECT_GT(dropped, kFrames / 4);
    EXPECT_GT(frames, 0);
    EXPECT_EQ(report.at("heap_calls_after_ready"), 0);
    EXPECT_LT(GrownBytes(report), 2'000'000);
    EXPECT_LT(kPeriod_ms, report.at("stages").at("total").at("p50_ms"));
    // What queues up would add up to the whole recording.
    const json& latency = report.at("stages").at("latency");
    EXPECT_GT(latency.at("p50_ms"), 0);
    EXPECT_LT(latency.at("p99_ms").get<double>(),
              600 + 3 * report.at("stages").at("total").at("max_ms").get<double>());
}

TEST_F(RealTimeRunTest, EveryStoreSaysHowNearItCameToRunningDry) {
    const json pools = Report({"run", "--frames", "30"}).at("pools");
    EXPECT_EQ(pools.size(), 10U);  // eight cameras, panoramas, hitch angles
    for (const auto& [name, pool] : pools.items()) {
        EXPECT_GE(pool.at("low_water"), 0) << name;
        EXPECT_LE(pool.at("low_water"), pool.at("slots")) << name;
    }
    EXPECT_GT(pools.at("hitch_angle").at("low_water"), 0);
}

}  // namespace
}  // namespace hitchview::app
