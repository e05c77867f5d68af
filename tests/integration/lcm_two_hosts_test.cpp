#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "app/jpeg_encoder.hpp"
#include "app/receive_buffer.hpp"
#include "drivers/lcm_publisher.hpp"
#include "drivers/lcm_receive_buffer.hpp"
#include "drivers/lcm_subscriber.hpp"
#include "drivers/steady_clock.hpp"
#include "tests/support/i420_picture.hpp"

// The vehicle's computer and a display unit, two hosts with a cable between them. Runs in network
// namespaces of its own (tests/support/lcm_two_hosts.sh). HITCHVIEW_LCM_SECONDS=600 makes the
// deliveries as long as a drive, and the largest pictures as many a second.
namespace hitchview {
namespace {

using std::chrono::milliseconds;
using tests::I420Picture;

constexpr int kWidth_px = 2048;
constexpr int kHeight_px = 360;
constexpr hal::Instant kPeriod{33'333'333};
/// Of the largest pictures: a busy machine does not copy 120 MB/s in time.
constexpr hal::Instant kEasyPeriod = 3 * kPeriod;
constexpr const char* kNetworkUrl = "udpm://239.255.76.67:7667?ttl=1";
constexpr int kLargestBytes = 4'000'000;  // of publish.max_bytes

bool IsLong() {
    return std::getenv("HITCHVIEW_LCM_SECONDS") != nullptr;
}

int FramesOf(int usual_seconds) {
    return 30 * (IsLong() ? std::atoi(std::getenv("HITCHVIEW_LCM_SECONDS")) : usual_seconds);
}

/// bot_core_receiver on the other host.
class Receiver {
 public:
    Receiver(const char* url, int frames, int timeout_s)
        : output_(popen((std::string("exec nsenter --net=") + std::getenv("HITCHVIEW_OTHER_HOST") +
                         " " BOT_CORE_RECEIVER " '" + url + "' PANORAMA " + std::to_string(frames) +
                         " " + std::to_string(timeout_s))
                            .c_str(),
                        "r")) {
        EXPECT_EQ(ReadLine(), "ready\n");
    }
    ~Receiver() { pclose(output_); }
    Receiver(const Receiver&) = delete;
    Receiver& operator=(const Receiver&) = delete;

    std::string ReadLine() {
        std::array<char, 256> line{};
        return std::fgets(line.data(), line.size(), output_) == nullptr ? "" : line.data();
    }

 private:
    std::FILE* output_;
};

std::string AllArrived(int frames) {
    return "received " + std::to_string(frames) + " missing 0 undecodable 0\n";
}

/// Real JPEG pictures of exactly so many bytes: what follows their end no decoder reads.
std::vector<std::vector<std::uint8_t>> PicturesOfBytes(std::size_t bytes) {
    std::vector<std::vector<std::uint8_t>> pictures;
    app::JpegEncoder encoder({kWidth_px, kHeight_px, hal::PixelFormat::kI420, hal::Range::kFull},
                             {});
    for (int i = 0; i < 8; ++i) {
        const auto jpeg = encoder.Encode(I420Picture::Waves(kWidth_px, kHeight_px, 7 * i).view());
        pictures.emplace_back(jpeg.value().begin(), jpeg.value().end());
        EXPECT_LE(pictures.back().size(), bytes);
        pictures.back().resize(bytes);
    }
    return pictures;
}

class LcmTwoHostsTest : public testing::Test {
 protected:
    void SetUp() override {
        if (std::getenv("HITCHVIEW_OTHER_HOST") == nullptr)
            GTEST_SKIP() << "needs tests/support/lcm_two_hosts.sh";
    }

    void Open(const char* url, int max_image_bytes) {
        auto publisher = drivers::LcmPublisher::Create(
            {.url = url, .messages = {.max_image_bytes = max_image_bytes}}, clock_);
        ASSERT_TRUE(publisher) << publisher.error();
        publisher_ = std::move(publisher.value());
    }

    /// What is late is not made up for in a hurry, nor does the program. How long the slowest took
    /// to be handed over.
    hal::Instant Publish(int frames, const std::vector<std::vector<std::uint8_t>>& pictures,
                         hal::Instant period = kPeriod) {
        hal::Instant slowest{};
        hal::Instant due = clock_.Now();
        for (int i = 0; i < frames; ++i) {
            clock_.SleepUntil(due);
            const hal::Instant now = clock_.Now();
            due = std::max(due, now - period) + period;
            EXPECT_TRUE(publisher_->Publish(hal::PanoramaImage{
                .sequence = static_cast<std::uint32_t>(i),
                .captured_from = now,
                .captured_until = now,
                .width_px = kWidth_px,
                .height_px = kHeight_px,
                .jpeg = pictures[static_cast<std::size_t>(i) % pictures.size()]}));
            slowest = std::max(slowest, clock_.Now() - now);
        }
        return slowest;
    }

    drivers::SteadyClock clock_;
    std::unique_ptr<drivers::LcmPublisher> publisher_;
};

double Ms(hal::Instant duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

TEST_F(LcmTwoHostsTest, EveryPanoramaOfTheUsualBudgetReachesTheDisplayUnit) {
    const int frames = FramesOf(5);
    Open(kNetworkUrl, app::kUsualBufferImageBytes);
    const auto pictures = PicturesOfBytes(app::kUsualBufferImageBytes);
    Receiver receiver(kNetworkUrl, frames, frames / 30 + 20);
    const hal::Instant slowest = Publish(frames, pictures);
    const std::string line = receiver.ReadLine();
    EXPECT_EQ(line, AllArrived(frames));
    std::printf("  %d panoramas of %d bytes, slowest hand-over %.2f ms: %s", frames,
                app::kUsualBufferImageBytes, Ms(slowest), line.c_str());
}

TEST_F(LcmTwoHostsTest, EveryPanoramaOfTheLargestBudgetReachesIt) {
    const auto buffers = drivers::ReadSocketBuffers();
    ASSERT_TRUE(buffers);
    if (buffers->largest_bytes < kLargestBytes)
        GTEST_SKIP() << "net.core.rmem_max is " << buffers->largest_bytes;
    const int frames = FramesOf(1);
    Open(kNetworkUrl, kLargestBytes);
    const auto pictures = PicturesOfBytes(kLargestBytes);
    Receiver receiver(kNetworkUrl, frames, frames / 10 + 20);
    const hal::Instant slowest = Publish(frames, pictures, IsLong() ? kPeriod : kEasyPeriod);
    const std::string line = receiver.ReadLine();
    EXPECT_EQ(line, AllArrived(frames));
    std::printf("  %d panoramas of %d bytes, slowest hand-over %.2f ms: %s", frames, kLargestBytes,
                Ms(slowest), line.c_str());
}

TEST_F(LcmTwoHostsTest, TheDefaultUrlStaysOnTheHost) {
    Open(drivers::kDefaultLcmUrl, app::kUsualBufferImageBytes);
    Receiver receiver(kNetworkUrl, 1, 1);
    Publish(15, PicturesOfBytes(app::kUsualBufferImageBytes));
    EXPECT_EQ(receiver.ReadLine(), "received 0 missing 1 undecodable 0\n");
}

/// A display that takes 50 ms for each picture.
class SlowDisplay {
 public:
    explicit SlowDisplay(const hal::Clock& clock) : clock_(clock) {
        auto subscriber = drivers::LcmSubscriber::Create({.url = kNetworkUrl});
        EXPECT_TRUE(subscriber) << subscriber.error();
        subscriber_ = std::move(subscriber.value());
        thread_ = std::thread([this] { Work(); });
    }
    ~SlowDisplay() { Finish(); }
    SlowDisplay(const SlowDisplay&) = delete;
    SlowDisplay& operator=(const SlowDisplay&) = delete;

    /// Of each picture that was seen: how old it was then.
    std::vector<hal::Instant> Finish() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        return ages_;
    }

 private:
    void Work() {
        while (!stop_) {
            const auto image = subscriber_->WaitImage(milliseconds(100));
            if (!image) continue;
            ages_.push_back(clock_.Now() - image.value().captured_until);
            std::this_thread::sleep_for(milliseconds(50));
        }
    }

    const hal::Clock& clock_;
    std::unique_ptr<drivers::LcmSubscriber> subscriber_;
    std::vector<hal::Instant> ages_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST_F(LcmTwoHostsTest, ASlowDisplaySeesFreshPicturesAndDoesNotSlowThePublisher) {
    const int frames = FramesOf(4);
    Open(kNetworkUrl, app::kUsualBufferImageBytes);
    const auto pictures = PicturesOfBytes(app::kUsualBufferImageBytes);
    const hal::Instant alone = Publish(30, pictures);
    SlowDisplay display(clock_);
    const hal::Instant slowest = Publish(frames, pictures);
    std::vector<hal::Instant> ages = display.Finish();
    ASSERT_GT(ages.size(), static_cast<std::size_t>(frames) / 4);
    std::ranges::sort(ages);
    std::printf(
        "  saw %zu of %d, age median %.1f ms, oldest %.1f ms; hand-over %.2f ms, alone %.2f ms\n",
        ages.size(), frames, Ms(ages[ages.size() / 2]), Ms(ages.back()), Ms(slowest), Ms(alone));
    EXPECT_LE(ages[ages.size() / 2], milliseconds(60));
    EXPECT_LE(ages.back(), milliseconds(100));
    EXPECT_LT(slowest, kPeriod);
}

}  // namespace
}  // namespace hitchview
