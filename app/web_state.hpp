#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/web_cameras.hpp"
#include "app/web_history.hpp"
#include "app/web_pictures.hpp"
#include "hal/frame.hpp"

namespace hitchview::app {

/// LCM channels that the page shows.
struct WebChannels {
    std::string panorama = "PANORAMA";
    std::string status = "PANORAMA_STATUS";
    std::string hitch_angle = "HITCH_ANGLE";
    std::string event = "PANORAMA_EVENT";
    std::string health = "PANORAMA_HEALTH";
    std::string overlay = "PANORAMA_OVERLAY";
    std::string preview_prefix = "PREVIEW_";  ///< and the camera's name in upper case
};

/// Everything that the page shows, made of messages that nobody vouches for: what is not sound is
/// counted and left out. All memory is bounded. Thread: one.
class WebState {
 public:
    /// What a client has been told already.
    struct Cursor {
        std::uint64_t status = 0;
        std::uint64_t hitch_angle = 0;
        std::uint64_t event = 0;
        std::uint64_t health = 0;
        bool operator==(const Cursor&) const = default;
    };

    explicit WebState(WebChannels channels, std::vector<WebCamera> cameras = {});

    void Take(std::string_view channel, std::span<const std::uint8_t> message, hal::Instant now);

    /// JSON in one line: the state at `now`, and what came behind `cursor`, which is moved on.
    [[nodiscard]] std::string News(Cursor& cursor, hal::Instant now) const;

    /// Whether something came since the last call that should not wait: an event, another set of
    /// missing cameras.
    bool TakeUrgency() { return std::exchange(urgent_, false); }

    [[nodiscard]] const WebPictures& pictures() const { return pictures_; }

    /// Newest overlay as JSON, and its number; 0 without one.
    [[nodiscard]] const std::string& overlay() const { return overlay_; }
    [[nodiscard]] std::uint64_t overlay_serial() const { return overlay_serial_; }

    [[nodiscard]] std::uint64_t refused() const { return refused_; }  ///< messages, since start

 private:
    struct TracedStatus {
        hal::Instant at{};
        double latency_ms = 0;
        double total_ms = 0;
        double articulation_deg = 0;
    };
    struct TracedAngle {
        hal::Instant at{};
        double angle_deg = 0;  ///< not a number unless valid
    };

    [[nodiscard]] bool TakeMessage(std::string_view channel, std::span<const std::uint8_t> message,
                                   hal::Instant now);
    [[nodiscard]] bool TakeStatus(std::span<const std::uint8_t> message, hal::Instant now);
    [[nodiscard]] bool TakeHitchAngle(std::span<const std::uint8_t> message, hal::Instant now);
    [[nodiscard]] bool TakeEvent(std::span<const std::uint8_t> message, hal::Instant now);
    [[nodiscard]] bool TakeHealth(std::span<const std::uint8_t> message, hal::Instant now);
    [[nodiscard]] bool TakeOverlay(std::span<const std::uint8_t> message);

    [[nodiscard]] nlohmann::json PanoramaNews(hal::Instant now) const;
    [[nodiscard]] nlohmann::json Traces(const Cursor& cursor) const;

    WebChannels channels_;
    WebCameras cameras_;
    WebPictures pictures_{};

    nlohmann::json status_{};
    std::optional<hal::Instant> status_at_{};
    std::uint32_t missing_ = 0;
    WebHistory<TracedStatus> statuses_;

    nlohmann::json angle_{};
    std::optional<hal::Instant> angle_at_{};
    std::optional<hal::Instant> angle_traced_at_{};
    WebHistory<TracedAngle> angles_;

    WebHistory<nlohmann::json> events_;

    nlohmann::json health_{};
    std::optional<hal::Instant> health_at_{};
    std::uint64_t health_serial_ = 0;

    std::string overlay_{};
    std::uint64_t overlay_serial_ = 0;

    bool urgent_ = false;
    std::uint64_t refused_ = 0;
};

}  // namespace hitchview::app
