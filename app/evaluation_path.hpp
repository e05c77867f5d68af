#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace hitchview::app {

/// Energy share of the 2nd to 6th frequency of a path, DC being the first and left out (Liu et al.
/// 2013, section 6), one-sided. [0, 1], 1 is steady. Empty for a path that does not move.
struct SlowShares {
    std::optional<double> translation;  ///< of x and y together
    std::optional<double> rotation;

    /// Both: of what is known.
    [[nodiscard]] std::optional<double> Mean() const;
    [[nodiscard]] std::optional<double> Smaller() const;
};

/// Steadiness of one video. Every figure is empty for fewer than 16 frames.
struct PathScores {
    SlowShares stability;
    /// The same of the first 300 frames (or all, if fewer) without mean and trend under a Hann
    /// window: a pan, which fills the lowest frequencies of any path, does not count as steadiness.
    SlowShares stability_detrended;
    int stability_frames =
        0;  ///< that `stability_detrended` is of: comparable at the same number only
    std::optional<double> jerk_px;       ///< rms second difference of the frame centre's path
    std::optional<double> rot_jerk_rad;  ///< rms second difference of the rotation
};

/// Camera path of one video: corners tracked from frame to frame, a similarity fitted to them by
/// RANSAC (fixed seed), motions of the frame centre summed. Deterministic.
class PathMeter {
 public:
    /// `grey`: the next frame, all of one size.
    void Append(const cv::Mat& grey);

    [[nodiscard]] PathScores Scores() const;
    /// Centre position (x, y, px) and rotation (rad) of each frame; the first one is zero.
    [[nodiscard]] const std::vector<cv::Vec3d>& path() const { return path_; }
    /// Frames whose motion could not be found; they count as still.
    [[nodiscard]] int lost() const { return lost_; }
    /// Frames equal to the one before.
    [[nodiscard]] int repeated() const { return repeated_; }

 private:
    cv::Mat early_;
    std::vector<cv::Vec3d> path_;
    int lost_ = 0;
    int repeated_ = 0;
};

/// Shake that is left: sqrt of the energy above 1 Hz in the translation of `out` over that of `in`,
/// both without trend under a Hann window. Empty for fewer than 16 frames, or when `in` does not
/// shake.
std::optional<double> JitterRatio(const PathMeter& out, const PathMeter& in, double rate_hz);

/// Shake by frequency.
struct Spectrum {
    std::vector<double> hz;            ///< rising, without 0
    std::vector<double> amplitude_px;  ///< of the sinusoid at that frequency, x and y together
};

/// Translation of a path without trend under a Hann window. Empty for fewer than 16 frames.
Spectrum ShakeSpectrum(const std::vector<cv::Vec3d>& path, double rate_hz);

}  // namespace hitchview::app
