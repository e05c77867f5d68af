#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <linux/can/error.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <thread>
#include <vector>

#include "app/program.hpp"
#include "drivers/lcm_log_messages.hpp"
#include "hal/hitch_angle.hpp"
#include "lcmtypes/hitchview_hitch_angle_t.h"
#include "tests/support/recorded_events.hpp"
#include "tests/support/sine_texture.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_can.hpp"

// `hitchview run` on a live bus.
namespace hitchview::app {
namespace {

using hal::HitchAngleQuality;
using std::chrono::milliseconds;

constexpr int kFrameSets = 150;

std::int64_t Now_ns() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

/// The angles that are published meanwhile.
class AngleLog {
 public:
    AngleLog() : lcm_(lcm_create("udpm://239.255.76.67:7667?ttl=0")) {
        EXPECT_NE(lcm_, nullptr);
        lcm_subscribe(lcm_, "HITCH_ANGLE", Append, this);
        lcm_subscribe(
            lcm_, "HITCHVIEW_START",
            [](const lcm_recv_buf_t*, const char*, void* log) {
                static_cast<AngleLog*>(log)->started = true;
            },
            this);
        thread_ = std::thread([this] {
            while (!stop_) lcm_handle_timeout(lcm_, 50);
        });
    }
    ~AngleLog() { Finish(); }
    AngleLog(const AngleLog&) = delete;
    AngleLog& operator=(const AngleLog&) = delete;

    void Finish() {
        if (!thread_.joinable()) return;
        stop_ = true;
        thread_.join();
        lcm_destroy(lcm_);
    }
    [[nodiscard]] std::size_t Count(HitchAngleQuality quality) const {
        return static_cast<std::size_t>(std::ranges::count_if(
            angles, [&](const auto& angle) { return angle.quality == int(quality); }));
    }

    std::vector<hitchview_hitch_angle_t> angles;
    std::atomic<bool> started{false};  // the program publishes, its bus is open

 private:
    static void Append(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* log) {
        hitchview_hitch_angle_t angle{};
        EXPECT_GT(hitchview_hitch_angle_t_decode(buffer->data, 0,
                                                 static_cast<int>(buffer->data_size), &angle),
                  0);
        hitchview_hitch_angle_t_decode_cleanup(&angle);  // it has numbers only
        static_cast<AngleLog*>(log)->angles.push_back(angle);
    }

    lcm_t* lcm_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

can_frame YawFrame(unsigned raw) {
    can_frame frame{};
    frame.can_id = 1111;
    frame.len = 8;
    frame.data[2] = static_cast<std::uint8_t>(raw >> 4);
    frame.data[3] = static_cast<std::uint8_t>(raw << 4);
    return frame;
}

class SocketCanRunTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::HasVirtualCan()) GTEST_SKIP() << "no virtual CAN interfaces here";
        ASSERT_EQ(tests::Shell("ip link set lo up multicast on && "
                               "ip route replace 224.0.0.0/4 dev lo"),
                  0);
        can_ = std::make_unique<tests::VirtualCan>("vcan0");
        RecordCamera();
        folder_.Write("x.dbc",
                      "BO_ 1111 Yaw: 8 X\n"
                      " SG_ Angle : 23|12@0+ (0.1,-90) [-90|90] \"deg\" X\n"
                      "VAL_ 1111 Angle 4095 \"Faulty\";\n");
    }

    // One still picture, again and again.
    void RecordCamera() {
        std::filesystem::create_directories(folder_ / "a");
        const tests::SineTexture texture(7);
        const std::string first = folder_ / "a/0.png";
        ASSERT_TRUE(cv::imwrite(first, texture.Shifted({160, 120}, 0, 0)));
        for (int i = 1; i < kFrameSets; ++i)
            std::filesystem::create_hard_link(first, folder_ / ("a/" + std::to_string(i) + ".png"));
    }

    std::string Rig(const std::string& interface, const std::string& more = "") {
        return folder_.Write(
            "rig.yaml",
            "schema: 1\n"
            "canvas: {projection: plane, size_px: [160, 120]}\n"
            "period_ms: 33.333\n"
            "units: {tractor: {cameras: [{name: a, source: {replay: a}}]}}\n"
            "can:\n"
            "  source: {socketcan: " +
                interface +
                "}\n"
                "  hitch_angle: {dbc: x.dbc, message: Yaw, signal: Angle, max_age_ms: 300}\n" +
                more);
    }

    int Run(const std::string& rig) {
        return RunProgram(SiblingProgram("hitchview"),
                          {"run", "--rig", rig, "--out", folder_ / "out"});
    }

    nlohmann::json Report() {
        std::ifstream file(folder_ / "out/report.json");
        return nlohmann::json::parse(file, nullptr, false);
    }

    tests::TemporaryFolder folder_;
    std::unique_ptr<tests::VirtualCan> can_;
};

TEST_F(SocketCanRunTest, AnglesArePublishedAsTheyComeAlsoAfterTheInterfaceWasAway) {
    AngleLog log;
    const std::int64_t start_ns = Now_ns();
    std::atomic<bool> ran{false};
    std::thread traffic([&] {
        while (!log.started && !ran) std::this_thread::sleep_for(milliseconds(10));
        const auto send = [&](int frames, unsigned raw) {
            tests::CanSender sender("vcan0");
            for (int i = 0; i < frames; ++i, std::this_thread::sleep_for(milliseconds(10)))
                sender.Send(YawFrame(raw));
        };
        send(50, 1000);  // 10 degrees
        {
            tests::CanSender sender("vcan0");
            can_frame error{};
            error.can_id = CAN_ERR_FLAG | CAN_ERR_ACK;
            error.len = 8;
            for (int i = 0; i < 7; ++i) sender.Send(error);
            sender.Send(YawFrame(4095));
            std::this_thread::sleep_for(milliseconds(100));
        }
        can_->Delete();
        std::this_thread::sleep_for(milliseconds(800));
        can_->Add();
        while (!ran) send(10, 800);  // -10 degrees
    });
    EXPECT_EQ(Run(Rig("vcan0")), 0);
    ran = true;
    traffic.join();
    const std::int64_t end_ns = Now_ns();
    std::this_thread::sleep_for(milliseconds(200));
    log.Finish();

    EXPECT_GT(log.Count(HitchAngleQuality::kValid), 40U);
    EXPECT_EQ(log.Count(HitchAngleQuality::kError), 1U);
    EXPECT_GE(log.Count(HitchAngleQuality::kStale), 1U);
    bool to_the_left = false;
    bool to_the_right = false;
    for (const auto& angle : log.angles) {
        EXPECT_GE(angle.capture_ns, start_ns);
        EXPECT_LE(angle.capture_ns, end_ns);
        if (angle.valid == 0) continue;
        EXPECT_NEAR(std::abs(angle.angle_rad), 10 * std::numbers::pi / 180, 1e-9);
        (angle.angle_rad > 0 ? to_the_left : to_the_right) = true;
    }
    EXPECT_TRUE(to_the_left) << "before the interface went";
    EXPECT_TRUE(to_the_right) << "after it was back";
    const nlohmann::json can = Report()["can"];
    EXPECT_EQ(can["errors"], 7);
    EXPECT_EQ(can["dropped"], 0);
    EXPECT_GE(can["disconnections"], 1);
    EXPECT_GT(can["frames"], 60);
    EXPECT_EQ(Report()["heap_calls_after_ready"], 0) << Report()["heap_calls_by_thread"];
}

TEST_F(SocketCanRunTest, WhileItRecordsEveryFrameOfTheBusIsInTheLog) {
    const std::string drives = folder_ / "drives";
    std::filesystem::create_directory(drives);
    std::atomic<bool> ran{false};
    std::thread traffic([&] {
        while (tests::Segments(drives).empty() && !ran)
            std::this_thread::sleep_for(milliseconds(10));
        tests::CanSender sender("vcan0");
        for (const canid_t id : {canid_t{1111}, canid_t{0x555}, 0x18ff7a27 | CAN_EFF_FLAG,
                                 0x123 | CAN_RTR_FLAG, CAN_ERR_FLAG | CAN_ERR_ACK}) {
            can_frame frame = YawFrame(1000);
            frame.can_id = id;
            for (int i = 0; i < 20; ++i) sender.Send(frame);
        }
    });
    EXPECT_EQ(Run(Rig("vcan0", "record: {folder: drives, min_free_mb: 0}\n")), 0);
    ran = true;
    traffic.join();
    std::map<std::pair<std::uint32_t, hal::CanFrameKind>, int> frames;
    for (const auto& event : tests::RecordedEvents(drives)) {
        if (event.channel != "CAN_RX") continue;
        const auto logged = drivers::ParseLoggedCanFrame(event.data);
        ASSERT_TRUE(logged);
        EXPECT_EQ(logged.value().bus, "vcan0");
        ++frames[{logged.value().frame.id, logged.value().frame.kind}];
    }
    ASSERT_EQ(frames.size(), 5U);
    for (const auto& [id, count] : frames) EXPECT_EQ(count, 20) << id.first;
    EXPECT_EQ((frames[{0x123, hal::CanFrameKind::kRemote}]), 20);
    EXPECT_EQ((frames[{CAN_ERR_ACK, hal::CanFrameKind::kError}]), 20);
    EXPECT_EQ(Report()["heap_calls_after_ready"], 0) << Report()["heap_calls_by_thread"];
}

TEST_F(SocketCanRunTest, AnInterfaceThatIsNotThereStopsTheProgramWithItsName) {
    EXPECT_EQ(Run(Rig("can9")), 3);
}

}  // namespace
}  // namespace hitchview::app
