#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/lcm_handle.hpp"
#include "drivers/lcm_url.hpp"
#include "hal/publisher.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

struct LcmSubscriberOptions {
    std::string url = kDefaultLcmUrl;
    std::string channel = "PANORAMA";
    std::string health_channel = "PANORAMA_HEALTH";
    int max_message_bytes = 9 << 20;  ///< larger ones are refused. [1024, 67108864]
};

/// Receives panoramas, the newest only: what came while a slow reader was busy is gone through at
/// once and the last sound one is given. (With LCM's own queue at capacity 1 the reader would get
/// the oldest of them.) The kernel is asked for a receive buffer of 16 MiB. Thread: the one that
/// calls WaitImage.
class LcmSubscriber {
 public:
    static hal::Checked<std::unique_ptr<LcmSubscriber>> Create(const LcmSubscriberOptions& options);

    /// Blocks until a message comes, at most `timeout`, then takes the newest of those that have
    /// come (of a log file: the next). The image is borrowed until the next call.
    /// kTimeout: none came; ordinary. kCorrupted: one came and is not a sound panorama. kTooLarge:
    /// it does not fit max_message_bytes. kFailed: LCM gave up.
    hal::Result<hal::PanoramaImage> WaitImage(std::chrono::milliseconds timeout);

    /// Of the publisher's cameras, as the newest sound health message tells; empty before one came.
    [[nodiscard]] const std::vector<std::string>& camera_names() const { return camera_names_; }

    [[nodiscard]] std::uint64_t received() const { return received_; }  ///< sound ones, since start
    [[nodiscard]] std::uint64_t refused() const { return refused_; }    ///< the others, since start

 private:
    LcmSubscriber(const LcmSubscriberOptions& options, LcmHandle lcm);

    using Handler = void (LcmSubscriber::*)(std::span<const std::uint8_t> message);
    template <Handler kHandler>
    bool Subscribe(const std::string& channel, int most_waiting);
    void OnMessage(std::span<const std::uint8_t> message);
    void OnHealth(std::span<const std::uint8_t> message);

    static constexpr int kMostWaiting = 8;

    LcmHandle lcm_;
    bool live_;  // messages come whether they are taken or not
    std::vector<std::uint8_t> message_;
    hal::Result<hal::PanoramaImage> image_ = hal::Error::kTimeout;
    std::vector<std::string> camera_names_;
    std::uint64_t received_ = 0;
    std::uint64_t refused_ = 0;
};

}  // namespace hitchview::drivers
