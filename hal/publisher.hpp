#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "hal/event.hpp"
#include "hal/frame.hpp"
#include "hal/health.hpp"
#include "hal/hitch_angle.hpp"
#include "hal/overlay.hpp"
#include "hal/result.hpp"

namespace hitchview::hal {

/// State of the alignment between tractor and trailer in one overlap.
enum class SeamState : std::uint8_t { kNoOverlap = 0, kReacquire = 1, kCoast = 2, kLocked = 3 };

constexpr const char* ToString(SeamState state) {
    switch (state) {
        case SeamState::kNoOverlap:
            return "NO_OVERLAP";
        case SeamState::kReacquire:
            return "REACQUIRE";
        case SeamState::kCoast:
            return "COAST";
        case SeamState::kLocked:
            return "LOCKED";
    }
    return "UNKNOWN";
}

/// A compressed panorama, borrowed for the call.
struct PanoramaImage {
    std::uint32_t sequence = 0;  ///< frame set it shows; a gap is a panorama that was dropped
    Instant captured_from{};     ///< start of the oldest exposure used
    Instant captured_until{};    ///< start of the newest exposure used
    int width_px = 0;
    int height_px = 0;
    std::uint32_t cameras_missing = 0;  ///< bit i: camera i of the rig shows no data
    std::string_view calibration_id{};  ///< empty for a rig without calibration
    std::span<const std::uint8_t> jpeg{};
};

/// A named part of a panorama, on a channel of its own; borrowed for the call.
struct ViewportImage {
    const char* channel = "";
    PanoramaImage image;  ///< size and JPEG are the part's, all else is the panorama's
};

/// One camera's frame, reduced and compressed, on a channel of its own; borrowed for the call.
struct PreviewImage {
    const char* channel = "";
    std::uint32_t sequence = 0;  ///< frame set that it is of
    Instant captured_at{};       ///< start of its exposure
    int width_px = 0;
    int height_px = 0;
    std::span<const std::uint8_t> jpeg{};
};

/// What the pipeline knows about the frame it has just made.
struct PanoramaStatus {
    std::uint32_t sequence = 0;
    Instant captured_from{};
    Instant published_at{};
    Instant spread{};  ///< from the oldest to the newest start of exposure
    std::uint32_t cameras_missing = 0;
    std::array<SeamState, 2> seams{};    ///< left, right
    std::array<int, 2> seam_matches{};   ///< inliers in this frame set
    std::array<int, 2> unit_features{};  ///< tracked intra features: tractor, trailer
    double total_ms = 0;                 ///< processing of this frame set
    std::uint64_t deadline_misses = 0;   ///< since start
    std::uint64_t dropped = 0;           ///< frame sets never shown, since start
    /// Yaw of the trailer relative to the tractor as the images tell it, positive to the left, and
    /// its standard deviation; not a number while it is not known.
    double articulation_rad = std::numeric_limits<double>::quiet_NaN();
    double articulation_sigma_rad = std::numeric_limits<double>::quiet_NaN();
};

/// Hands results to the display units. Borrowed data is copied or sent before the call returns.
/// Thread: the publisher's.
class Publisher {
 public:
    virtual ~Publisher() = default;

    /// kTooLarge: the image does not fit the encode buffer taken at start. kFailed: the socket
    /// refused.
    Result<Done> Publish(const PanoramaImage& image) { return DoPublish(image); }
    Result<Done> Publish(const PanoramaStatus& status) { return DoPublish(status); }
    Result<Done> Publish(const HitchAngle& angle) { return DoPublish(angle); }
    Result<Done> Publish(const Event& event) { return DoPublish(event); }
    Result<Done> Publish(const Health& health) { return DoPublish(health); }
    Result<Done> Publish(const ViewportImage& viewport) { return DoPublish(viewport); }
    Result<Done> Publish(const PreviewImage& preview) { return DoPublish(preview); }
    Result<Done> Publish(const Overlay& overlay) { return DoPublish(overlay); }

 private:
    virtual Result<Done> DoPublish(const PanoramaImage& image) = 0;
    virtual Result<Done> DoPublish(const PanoramaStatus& status) = 0;
    virtual Result<Done> DoPublish(const HitchAngle& angle) = 0;
    virtual Result<Done> DoPublish(const Event& event) = 0;
    // What not every receiver wants: a publisher that does not carry it is done at once.
    virtual Result<Done> DoPublish(const Health& /*health*/) { return Done{}; }
    virtual Result<Done> DoPublish(const ViewportImage& /*viewport*/) { return Done{}; }
    virtual Result<Done> DoPublish(const PreviewImage& /*preview*/) { return Done{}; }
    virtual Result<Done> DoPublish(const Overlay& /*overlay*/) { return Done{}; }
};

}  // namespace hitchview::hal
