#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <semaphore>

#include "app/panorama_publisher.hpp"
#include "hal/fake_clock.hpp"
#include "hal/fake_publisher.hpp"
#include "hal/fake_watchdog.hpp"
#include "tests/support/i420_picture.hpp"

namespace hitchview::app {
namespace {

using hal::FakeWatchdog;
using std::chrono::milliseconds;

/// A network that says of each panorama what the watchdog had been told before, and lets go of it
/// only when it may.
class WatchedNetwork final : public hal::Publisher {
 public:
    explicit WatchedNetwork(const FakeWatchdog& watchdog) : watchdog_(watchdog) {}

    struct Told {
        int readies = 0;
        int feeds = 0;
        bool operator==(const Told&) const = default;
    };
    std::vector<Told> told;  ///< read after the publisher's end
    std::counting_semaphore<> may_send{0};
    std::atomic<int> began{0};
    std::atomic<bool> refuses{false};

 private:
    hal::Result<hal::Done> DoPublish(const hal::PanoramaImage& /*image*/) override {
        ++began;
        may_send.acquire();
        told.push_back({watchdog_.readies, watchdog_.feeds});
        if (refuses) return hal::Error::kFailed;
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::PanoramaStatus& /*status*/) override {
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::HitchAngle& /*angle*/) override {
        return hal::Done{};
    }
    hal::Result<hal::Done> DoPublish(const hal::Event& /*event*/) override { return hal::Done{}; }

    const FakeWatchdog& watchdog_;
};

class WatchedPublisherTest : public testing::Test {
 protected:
    void Append() {
        PanoramaPublisher::Item item;
        item.picture = picture_.view();
        item.picture.header.sequence = ++sequence_;
        publisher_.Append(item);
    }
    /// Sends so many, one after the other.
    void Send(int panoramas) {
        for (int i = 0; i < panoramas; ++i) {
            const std::uint64_t done = publisher_.published() + publisher_.refused();
            network_.may_send.release();
            Append();
            while (publisher_.published() + publisher_.refused() < done + 2)
                std::this_thread::yield();  // the panorama and its status
        }
    }

    FakeWatchdog watchdog_;
    WatchedNetwork network_{watchdog_};
    hal::FakeClock clock_;
    const tests::I420Picture picture_ = tests::I420Picture::Waves(64, 64, 0);
    std::uint32_t sequence_ = 0;
    PanoramaPublisher publisher_{network_, clock_, {.watchdog = &watchdog_}, picture_.format(), {}};
};

TEST_F(WatchedPublisherTest, TheManagerIsToldOfAPanoramaThatTheNetworkHasTaken) {
    Send(3);
    publisher_.Finish();
    using Told = WatchedNetwork::Told;
    EXPECT_THAT(network_.told, testing::ElementsAre(Told{0, 0}, Told{1, 1}, Told{1, 2}));
    EXPECT_EQ(watchdog_.readies, 1);
    EXPECT_EQ(watchdog_.feeds, 3);
    EXPECT_EQ(watchdog_.stops, 1);
}

TEST_F(WatchedPublisherTest, APanoramaThatTheNetworkRefusesFeedsNobody) {
    network_.refuses = true;
    Send(2);
    EXPECT_EQ(watchdog_.readies, 0);
    EXPECT_EQ(watchdog_.feeds, 0);
    network_.refuses = false;
    Send(1);
    publisher_.Finish();
    EXPECT_EQ(watchdog_.readies, 1);
    EXPECT_EQ(watchdog_.feeds, 1);
}

TEST_F(WatchedPublisherTest, ANetworkThatHangsFeedsNobodyWhateverThePipelineMakes) {
    Send(1);
    while (network_.began < 2) Append();
    for (int i = 0; i < 50; ++i) {
        Append();
        std::this_thread::sleep_for(milliseconds(1));
    }
    EXPECT_EQ(watchdog_.feeds, 1);
    network_.may_send.release(8);
    publisher_.Finish();
}

TEST_F(WatchedPublisherTest, APipelineThatMakesNothingFeedsNobody) {
    Send(1);
    std::this_thread::sleep_for(milliseconds(100));  // ten beats of the publisher
    EXPECT_EQ(watchdog_.feeds, 1);
}

TEST(PanoramaPublisherTest, APanoramaThatNoQualityMakesSmallEnoughIsCountedAndFeedsNobody) {
    hal::FakePublisher network;
    hal::FakeClock clock;
    FakeWatchdog watchdog;
    const auto noise = tests::I420Picture::Noise(2048, 360, 255, 1);
    PanoramaPublisherOptions options;
    options.jpeg.budget_bytes = 15'000;
    options.drop_when_late = false;
    PanoramaPublisher publisher(network, clock, {.watchdog = &watchdog}, noise.format(), options);
    for (int i = 0; i < 3; ++i)
        publisher.Append({.picture = noise.view(), .captured_until = {}, .status = {}});
    publisher.Finish();
    EXPECT_EQ(publisher.refused(), 3U);
    EXPECT_TRUE(network.images.empty());
    EXPECT_EQ(watchdog.feeds, 0);
}

}  // namespace
}  // namespace hitchview::app
