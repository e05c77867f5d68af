#pragma once

#include <lcm/lcm.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hal/frame.hpp"
#include "lcmtypes/hitchview_event_t.h"
#include "lcmtypes/hitchview_panorama_status_t.h"
#include "tests/device/vivid.hpp"

namespace hitchview::tests {

/// What came over LCM, and when, by the clock that the program's own moments are of.
struct HeardStatus {
    hal::Instant at{};
    std::uint32_t cameras_missing = 0;
    hal::Instant spread{};
};
struct HeardEvent {
    hal::Instant at{};
    hal::Instant when{};  ///< as it says itself
    std::int16_t code = 0;
    std::string subject;
    std::string text;
};

/// Hears the statuses and the cameras' events of a program on this machine, on a thread of its own.
/// Multicast goes over the loopback interface from then on.
class PanoramaListener {
 public:
    PanoramaListener() : lcm_(Connect()) {
        lcm_subscribe(lcm_, "PANORAMA_STATUS", &OnMessage<&PanoramaListener::NoteStatus>, this);
        lcm_subscribe(lcm_, "PANORAMA_EVENT", &OnMessage<&PanoramaListener::NoteEvent>, this);
        thread_ = std::thread([this] {
            while (!stop_) lcm_handle_timeout(lcm_, 20);
        });
    }
    ~PanoramaListener() {
        stop_ = true;
        thread_.join();
        lcm_destroy(lcm_);
    }
    PanoramaListener(const PanoramaListener&) = delete;
    PanoramaListener& operator=(const PanoramaListener&) = delete;

    static hal::Instant Now() { return std::chrono::steady_clock::now().time_since_epoch(); }

    [[nodiscard]] std::vector<HeardStatus> statuses() const {
        const std::lock_guard lock(mutex_);
        return statuses_;
    }
    [[nodiscard]] std::vector<HeardEvent> events() const {
        const std::lock_guard lock(mutex_);
        return events_;
    }

 private:
    template <void (PanoramaListener::*kNote)(const void*, int)>
    static void OnMessage(const lcm_recv_buf_t* message, const char* /*channel*/, void* self) {
        (static_cast<PanoramaListener*>(self)->*kNote)(message->data,
                                                       static_cast<int>(message->data_size));
    }

    static lcm_t* Connect() {
        Shell("ip route add 224.0.0.0/4 dev lo 2>/dev/null");
        return lcm_create("udpm://239.255.76.67:7667?ttl=0");
    }

    void NoteStatus(const void* data, int bytes) {
        hitchview_panorama_status_t status{};
        if (hitchview_panorama_status_t_decode(data, 0, bytes, &status) < 0) return;
        const std::lock_guard lock(mutex_);
        statuses_.push_back({Now(), static_cast<std::uint32_t>(status.cameras_missing),
                             hal::Instant(status.spread_ns)});
        hitchview_panorama_status_t_decode_cleanup(&status);
    }
    void NoteEvent(const void* data, int bytes) {
        hitchview_event_t event{};
        if (hitchview_event_t_decode(data, 0, bytes, &event) < 0) return;
        const std::lock_guard lock(mutex_);
        constexpr int kLastCameraCode = 19;
        if (event.code <= kLastCameraCode) {
            events_.push_back(
                {Now(), hal::Instant(event.monotonic_ns), event.code, event.subject, event.text});
        }
        hitchview_event_t_decode_cleanup(&event);
    }

    mutable std::mutex mutex_;
    std::vector<HeardStatus> statuses_;
    std::vector<HeardEvent> events_;
    lcm_t* lcm_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

/// A camera was missing from one panorama to another.
struct Outage {
    hal::Instant from{};
    hal::Instant until{};
};

/// Those of a camera, in order. One that does not end lasts until the newest status.
inline std::vector<Outage> OutagesOf(std::size_t camera, const std::vector<HeardStatus>& statuses) {
    std::vector<Outage> outages;
    bool missing = false;
    for (const HeardStatus& status : statuses) {
        const bool was_missing =
            std::exchange(missing, (status.cameras_missing >> camera & 1) != 0);
        if (missing && !was_missing) outages.push_back({status.at, status.at});
        if (was_missing) outages.back().until = status.at;
    }
    return outages;
}

inline hal::Instant Longest(const std::vector<Outage>& outages) {
    hal::Instant longest{};
    for (const Outage& outage : outages) longest = std::max(longest, outage.until - outage.from);
    return longest;
}

}  // namespace hitchview::tests
