#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm_log_messages.hpp"
#include "drivers/lcm_logged_health.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

enum class WebCameraState {
    kUnknown,  ///< nothing was said of it lately
    kLive,
    kLost,  ///< its part of the panorama shows no data
};
const char* ToString(WebCameraState state);

/// What is known of a camera beside its state.
struct WebCamera {
    std::string name{};
    std::string unit{};
    double frames_per_s = 0;
    double age_ms = 0;
    std::int64_t delivered = 0;
    std::int64_t lost = 0;
    std::int64_t corrupted = 0;
    std::int64_t reopened = 0;
    bool has_figures = false;                  ///< what stands above came in a health message
    std::string condition = "good";            ///< as the newest health message or event says
    bool shown = true;                         ///< as the newest health message says
    std::optional<hal::Instant> lost_since{};  ///< an event said so
};

/// The cameras of the rig as three kinds of messages tell of them, each of which may be the first
/// to say that one is lost: status of a panorama, events, health. Order: that of the bits of
/// cameras_missing.
class WebCameras {
 public:
    static constexpr std::size_t kMostCameras = 32;

    /// `cameras`: known beforehand, at most kMostCameras; health messages replace them.
    explicit WebCameras(std::vector<WebCamera> cameras = {});

    void TakeMissing(std::uint32_t cameras_missing, hal::Instant now);
    void TakeHealth(const drivers::LoggedHealth& health, hal::Instant now);
    void TakeEvent(const drivers::LoggedEvent& event, hal::Instant now);

    [[nodiscard]] WebCameraState State(std::size_t camera, hal::Instant now) const;
    [[nodiscard]] const std::vector<WebCamera>& cameras() const { return cameras_; }
    [[nodiscard]] nlohmann::json ToJson(hal::Instant now) const;

 private:
    [[nodiscard]] bool IsLost(std::size_t camera, hal::Instant now) const;

    std::vector<WebCamera> cameras_;
    std::uint32_t missing_ = 0;
    std::optional<hal::Instant> status_at_{};
    std::optional<hal::Instant> health_at_{};
};

}  // namespace hitchview::app
