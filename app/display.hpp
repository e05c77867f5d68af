#pragma once

#include <chrono>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "hal/frame.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// What a display unit shows: the newest panorama, or 'NO IMAGE' when that is too old. A picture
/// that stands still must never look like a live one.
class Display {
 public:
    explicit Display(std::chrono::nanoseconds stale_after);

    /// Takes a received panorama. False: its JPEG does not decode to the stated size, and the
    /// picture before it goes on ageing. A panorama that came before (same sequence and capture
    /// time) does not make the picture younger. `now`: CLOCK_MONOTONIC of the display unit; the
    /// sender's clock is another one, so age counts from the arrival.
    bool Update(const hal::PanoramaImage& image, hal::Instant now);

    /// The picture to show at `now`.
    [[nodiscard]] cv::Mat Shown(hal::Instant now) const;
    [[nodiscard]] bool IsLive(hal::Instant now) const;

    /// The picture if `age` is within the limit, else 'NO IMAGE' on a plain background of its size.
    /// An empty picture is one that never came.
    [[nodiscard]] static cv::Mat Compose(const cv::Mat& picture, std::chrono::nanoseconds age,
                                         std::chrono::nanoseconds stale_after);

 private:
    [[nodiscard]] std::chrono::nanoseconds Age(hal::Instant now) const;

    std::chrono::nanoseconds stale_after_;
    cv::Mat picture_;
    std::uint32_t sequence_ = 0;
    hal::Instant captured_until_{};
    std::optional<hal::Instant> maybe_arrived_at_;
};

}  // namespace hitchview::app
