#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include "app/jpeg_encoder.hpp"
#include "drivers/lcm_publisher.hpp"
#include "drivers/steady_clock.hpp"
#include "tests/support/i420_picture.hpp"
#include "tests/support/refused_call.hpp"

// Runs in a network namespace of its own (tests/support/lcm_namespace.sh).
namespace hitchview {
namespace {

using std::chrono::milliseconds;
using tests::I420Picture;

constexpr int kWidth_px = 2048;
constexpr int kHeight_px = 360;

/// bot_core_receiver as a child process.
class Receiver {
 public:
    explicit Receiver(int frames) : output_(popen(Command(frames).c_str(), "r")) {
        EXPECT_EQ(ReadLine(), "ready\n");
    }

    /// Its last line and its exit code.
    std::pair<std::string, int> Finish() {
        std::string line = ReadLine();
        return {line, pclose(output_)};
    }

 private:
    static std::string Command(int frames) {
        return std::string(BOT_CORE_RECEIVER " '") + drivers::kDefaultLcmUrl + "' PANORAMA " +
               std::to_string(frames) + " 20";
    }
    std::string ReadLine() {
        std::array<char, 256> line{};
        return std::fgets(line.data(), line.size(), output_) == nullptr ? "" : line.data();
    }

    std::FILE* output_;
};

class LcmDeliveryTest : public testing::Test {
 protected:
    LcmDeliveryTest() {
        auto publisher = drivers::LcmPublisher::Create({}, clock_);
        EXPECT_TRUE(publisher) << publisher.error();
        publisher_ = std::move(publisher.value());
    }

    void Publish(std::uint32_t sequence, std::span<const std::uint8_t> jpeg) {
        ASSERT_TRUE(publisher_->Publish(hal::PanoramaImage{.sequence = sequence,
                                                           .captured_from = clock_.Now(),
                                                           .captured_until = clock_.Now(),
                                                           .width_px = kWidth_px,
                                                           .height_px = kHeight_px,
                                                           .jpeg = jpeg}));
    }

    drivers::SteadyClock clock_;
    std::unique_ptr<drivers::LcmPublisher> publisher_;
};

TEST_F(LcmDeliveryTest, NinetyPanoramasAtThirtyHertzAllArrive) {
    Receiver receiver(90);
    app::JpegEncoder encoder({kWidth_px, kHeight_px, hal::PixelFormat::kI420, hal::Range::kFull},
                             {});
    auto due = clock_.Now();
    for (std::uint32_t i = 0; i < 90; ++i) {
        const auto picture = I420Picture::Waves(kWidth_px, kHeight_px, static_cast<int>(7 * i));
        const auto jpeg = encoder.Encode(picture.view());
        ASSERT_TRUE(jpeg);
        // From the last number to zero: the step is one all the same.
        Publish(0xFFFFFFF0U + i, jpeg.value());
        due += milliseconds(33);
        clock_.SleepUntil(due);
    }

    const auto [line, exit_code] = receiver.Finish();
    EXPECT_EQ(line, "received 90 missing 0 undecodable 0\n");
    EXPECT_EQ(exit_code, 0);
}

TEST_F(LcmDeliveryTest, ANetworkThatTakesNothingIsToldAtTheStart) {
    // As a packet filter refuses, or a service's own IPAddressDeny=.
    const tests::RefusedCall send{__NR_sendmsg, 2, 0, EPERM};
    const bool tried = tests::WhileRefused(send, [&] {
        const auto publisher = drivers::LcmPublisher::Create({}, clock_);
        ASSERT_FALSE(publisher);
        EXPECT_EQ(publisher.error(),
                  std::string("LCM cannot send to '") + drivers::kDefaultLcmUrl + "'");
    });
    if (!tried) GTEST_SKIP() << "no filters of system calls in this kernel";
}

/// A JPEG of any length: a real one, and bytes after its end, which a decoder does not read.
std::vector<std::uint8_t> JpegOfBytes(std::size_t bytes) {
    const auto picture = I420Picture::Waves(kWidth_px, kHeight_px, 0);
    app::JpegEncoder encoder(picture.format(), {});
    const auto jpeg = encoder.Encode(picture.view()).value();
    std::vector<std::uint8_t> padded(jpeg.begin(), jpeg.end());
    padded.resize(bytes);
    return padded;
}

TEST_F(LcmDeliveryTest, TheLargestLegalImagesAllArrive) {
    constexpr long kNeededBytes = 2 << 20;
    long allowed_bytes = 0;
    std::ifstream("/proc/sys/net/core/rmem_max") >> allowed_bytes;
    if (allowed_bytes < kNeededBytes) {
        GTEST_SKIP() << "net.core.rmem_max is " << allowed_bytes << ", needs " << kNeededBytes;
    }
    const auto jpeg =
        JpegOfBytes(static_cast<std::size_t>(drivers::LcmEncoderOptions{}.max_image_bytes));
    Receiver receiver(15);
    for (std::uint32_t i = 0; i < 15; ++i) {
        Publish(i, jpeg);
        std::this_thread::sleep_for(milliseconds(66));
    }

    const auto [line, exit_code] = receiver.Finish();
    EXPECT_EQ(line, "received 15 missing 0 undecodable 0\n");
    EXPECT_EQ(exit_code, 0);
}

TEST_F(LcmDeliveryTest, TheReceiverNoticesAGapAndADamagedPicture) {
    auto jpeg = JpegOfBytes(100'000);
    Receiver receiver(3);
    Publish(1, jpeg);
    Publish(3, jpeg);
    jpeg.resize(1000);
    Publish(4, jpeg);

    const auto [line, exit_code] = receiver.Finish();
    EXPECT_EQ(line, "received 3 missing 1 undecodable 1\n");
    EXPECT_NE(exit_code, 0);
}

}  // namespace
}  // namespace hitchview
