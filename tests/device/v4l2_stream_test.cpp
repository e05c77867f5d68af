#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "tests/device/vivid.hpp"

namespace hitchview::drivers {
namespace {

using std::chrono::milliseconds;
using tests::Vivid;
using tests::VividCamera;

class V4l2StreamTest : public testing::Test {
 protected:
    void SetUp() override {
        if (!tests::VividIsThere()) GTEST_SKIP() << "this kernel has no virtual cameras (vivid)";
    }
};

struct Tally {
    std::uint64_t frames = 0;
    std::uint64_t gaps = 0;
    bool in_order = true;
};

/// Takes frames for a while, as a capture thread does, and keeps its own book.
Tally Watch(hal::Camera& camera, milliseconds span) {
    Tally tally;
    hal::FrameHeader last{};
    const auto end = std::chrono::steady_clock::now() + span;
    while (std::chrono::steady_clock::now() < end) {
        const auto frame = camera.WaitFrame(milliseconds(50));
        if (!frame) continue;
        const hal::FrameHeader header = frame.value().view().header;
        if (tally.frames++ > 0) {
            tally.gaps += header.sequence - last.sequence - 1;
            tally.in_order = tally.in_order && header.captured_at > last.captured_at;
        }
        last = header;
    }
    return tally;
}

TEST_F(V4l2StreamTest, EightCamerasDeliverAndAccountForEveryFrame) {
    constexpr int kCameras = 8;
    const Vivid vivid({.cameras = kCameras});
    ASSERT_TRUE(vivid.loaded());
    std::vector<std::unique_ptr<V4l2Camera>> cameras;
    for (int i = 0; i < kCameras; ++i) {
        auto camera = V4l2Camera::Open(VividCamera(i));
        ASSERT_TRUE(camera.ok()) << camera.error();
        cameras.push_back(std::move(camera.value()));
    }
    std::vector<Tally> tallies(kCameras);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < kCameras; ++i) {
        threads.emplace_back([&, i] { tallies[i] = Watch(*cameras[i], milliseconds(4000)); });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < kCameras; ++i) {
        const hal::CameraCounts counts = cameras[i]->counts();
        std::printf("camera %zu: %lu frames in 4 s, %lu lost, %lu unnumbered, %.1f of %.1f GB/s\n",
                    i, counts.delivered, counts.lost, counts.lost_unnumbered,
                    cameras[i]->facts().buffer_read_gb_per_s,
                    cameras[i]->facts().ordinary_read_gb_per_s);
        EXPECT_EQ(counts.delivered, tallies[i].frames);
        EXPECT_EQ(counts.lost, tallies[i].gaps);
        EXPECT_EQ(counts.corrupted, 0U);
        EXPECT_TRUE(tallies[i].in_order);
        // A machine that is busy beside drops frames; they are accounted for all the same.
        EXPECT_GE(counts.delivered + counts.lost, 4U * 27U);
        EXPECT_GE(counts.delivered, 4U * 18U);
    }
}

}  // namespace
}  // namespace hitchview::drivers
