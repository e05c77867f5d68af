#pragma once

#include <chrono>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "app/picture_age.hpp"
#include "hal/frame.hpp"
#include "hal/publisher.hpp"

namespace hitchview::app {

/// What a display unit shows: the newest panorama, or 'NO IMAGE' and why when that is too old. A
/// picture that stands still must never look like a live one.
class Display {
 public:
    /// `max_age`: of a picture since its capture, as far as clocks that differ can tell: see
    /// PictureAge.
    explicit Display(std::chrono::nanoseconds max_age) : max_age_(max_age) {}

    /// Takes a received panorama. False: its JPEG does not decode to the stated size, and the
    /// picture before it goes on ageing. `now`: CLOCK_MONOTONIC of the display unit.
    bool Update(const hal::PanoramaImage& image, hal::Instant now);
    /// A message came that is no sound panorama.
    void NoteDamaged() { damaged_ = true; }
    /// What the cameras are called, in the order of the bits of cameras_missing: the publisher is
    /// there, whether panoramas come or not.
    void SetCameraNames(std::vector<std::string> names) { camera_names_ = std::move(names); }

    /// The picture to show at `now`: with a line that names the cameras that give none, if any.
    [[nodiscard]] cv::Mat Shown(hal::Instant now) const;
    [[nodiscard]] bool IsLive(hal::Instant now) const;
    /// Why there is no picture; empty while there is.
    [[nodiscard]] std::string Reason(hal::Instant now) const;
    /// Names, or numbers where names are not known, of the cameras that the newest panorama lacks.
    [[nodiscard]] std::string MissingCameras() const;

 private:
    std::chrono::nanoseconds max_age_;
    cv::Mat picture_;
    PictureAge age_;
    std::uint32_t cameras_missing_ = 0;
    bool damaged_ = false;  // what came last was
    std::vector<std::string> camera_names_;
};

}  // namespace hitchview::app
