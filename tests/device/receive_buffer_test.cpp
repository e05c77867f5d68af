#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <thread>

#include "app/program.hpp"
#include "drivers/lcm_url.hpp"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_health_t.h"
#include "tests/support/temporary_folder.hpp"

// Large panoramas on a system whose sockets get small buffers, and with the settings that are
// shipped: only a virtual machine lets them be changed.
namespace hitchview::app {
namespace {

constexpr int kFrames = 30;

/// What subscribers on this machine are told.
class Listener {
 public:
    Listener()
        : lcm_(lcm_create(
              (std::string(drivers::kDefaultLcmUrl) + "&recv_buf_size=16777216").c_str())) {
        lcm_subscribe(lcm_, "PANORAMA", &On<&Listener::NoteImage>, this);
        lcm_subscribe(lcm_, "PANORAMA_HEALTH", &On<&Listener::NoteHealth>, this);
        lcm_subscribe(lcm_, "PANORAMA_EVENT", &On<&Listener::NoteEvent>, this);
        thread_ = std::thread([this] {
            while (!stop_) lcm_handle_timeout(lcm_, 20);
        });
    }
    ~Listener() {
        Finish();
        lcm_destroy(lcm_);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// Before the members are read.
    void Finish() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }

    int images = 0;
    int largest_bytes = 0;
    int budget_bytes = 0;
    std::string warning;
    std::set<int> codes;

 private:
    template <void (Listener::*kNote)(const void*, int)>
    static void On(const lcm_recv_buf_t* message, const char*, void* self) {
        (static_cast<Listener*>(self)->*kNote)(message->data, static_cast<int>(message->data_size));
    }
    void NoteImage(const void* /*data*/, int bytes) {
        ++images;
        largest_bytes = std::max(largest_bytes, bytes);
    }
    void NoteHealth(const void* data, int bytes) {
        hitchview_health_t health{};
        if (hitchview_health_t_decode(data, 0, bytes, &health) < 0) return;
        budget_bytes = health.image_budget_bytes;
        warning = health.warning;
        hitchview_health_t_decode_cleanup(&health);
    }
    void NoteEvent(const void* data, int bytes) {
        hitchview_event_t event{};
        if (hitchview_event_t_decode(data, 0, bytes, &event) < 0) return;
        codes.insert(event.code);
        hitchview_event_t_decode_cleanup(&event);
    }

    lcm_t* lcm_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

class ReceiveBufferTest : public testing::Test {
 protected:
    void SetUp() override {
        if (std::getenv("VM_OUT") == nullptr) GTEST_SKIP() << "not in the virtual machine";
        ASSERT_EQ(std::system("ip link set lo up multicast on && "
                              "ip route replace 224.0.0.0/4 dev lo"),
                  0);
        WritePictures();
    }

    /// Rough enough to be large as JPEG.
    void WritePictures() {
        std::filesystem::create_directories(folder_ / "front");
        cv::Mat picture(720, 1280, CV_8U);
        cv::randn(picture, 128, 14);
        ASSERT_TRUE(cv::imwrite(folder_ / "front/0.jpg", picture));
        for (int i = 1; i < kFrames; ++i) {
            std::filesystem::create_hard_link(folder_ / "front/0.jpg",
                                              folder_ / ("front/" + std::to_string(i) + ".jpg"));
        }
    }

    /// Thirty panoramas, ten a second, with this setting of the system.
    void Run(const std::string& sysctl) {
        ASSERT_EQ(std::system(("sysctl -q " + sysctl).c_str()), 0);
        listener_ = std::make_unique<Listener>();
        const std::string rig =
            folder_.Write("rig.yaml",
                          "schema: 1\ncanvas: {projection: plane, size_px: [1280, 720]}\n"
                          "units: {tractor: {cameras: [{name: front, source: {replay: front}}]}}\n"
                          "stabilization: {enabled: false}\nthreads: {workers: 1}\nperiod_ms: 100\n"
                          "publish: {max_bytes: 4000000}\n");
        EXPECT_EQ(RunProgram(HITCHVIEW, {"run", "--rig", rig, "--out", folder_ / "out"}), 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        listener_->Finish();
        report_ = nlohmann::json::parse(tests::FileText(folder_ / "out/report.json"));
        std::printf("  %d of %d arrived, the largest %d bytes of %d; %s\n", listener_->images,
                    Sent(), listener_->largest_bytes, listener_->budget_bytes,
                    listener_->warning.c_str());
    }
    [[nodiscard]] int Sent() const { return report_.at("frames"); }

    tests::TemporaryFolder folder_;
    std::unique_ptr<Listener> listener_;
    nlohmann::json report_;
};

TEST_F(ReceiveBufferTest, WhereItIsSmallThePicturesAreMadeToFitAndTheReasonIsTold) {
    Run("-w net.core.rmem_max=212992 net.core.rmem_default=212992");
    EXPECT_EQ(listener_->images, Sent());
    EXPECT_EQ(listener_->budget_bytes, 150'000);
    EXPECT_LE(listener_->largest_bytes, 151'000);
    EXPECT_GT(listener_->largest_bytes, 50'000);
    EXPECT_TRUE(listener_->codes.contains(HITCHVIEW_EVENT_T_RECEIVE_BUFFER_SMALL));
    EXPECT_NE(listener_->warning.find("sysctl -w net.core.rmem_max=16777216"), std::string::npos);
    const std::string doctor = std::string(HITCHVIEW " doctor --rig ") + (folder_ / "rig.yaml");
    EXPECT_NE(std::system(doctor.c_str()), 0);
}

TEST_F(ReceiveBufferTest, WithTheShippedSettingTheyAreSentAsLargeAsTheyAre) {
    Run("-p " HITCHVIEW_SOURCE_DIR "/systemd/sysctl/90-hitchview.conf");
    EXPECT_EQ(listener_->images, Sent());
    EXPECT_EQ(listener_->budget_bytes, 4'000'000);
    EXPECT_GT(listener_->largest_bytes, 250'000);
    EXPECT_FALSE(listener_->codes.contains(HITCHVIEW_EVENT_T_RECEIVE_BUFFER_SMALL));
    EXPECT_EQ(listener_->warning, "");
}

}  // namespace
}  // namespace hitchview::app
