#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hitchview::calib {

/// The vehicle's hitch angle and the articulation from the images at the same moment, positive to
/// the left.
struct AnglePair {
    double time_s = 0;
    double sensor_rad = 0;
    double image_rad = 0;
};

/// image = factor * sensor + offset.
struct AngleFit {
    double factor = 1;
    double factor_sigma = 0;
    double offset_rad = 0;
    double offset_sigma_rad = 0;
    double spread_rad = 0;    ///< of the sensor's angles, from the 2nd to the 98th of a hundred
    double straight_s = 0;    ///< seconds within 2 degrees of straight, by the images
    double scatter_rad = 0;   ///< standard deviation of a second's median from the line, robust
    std::size_t seconds = 0;  ///< that were compared
};

/// Robust regression (iteratively reweighted, Tukey's biweight) over the medians of each second, so
/// that neighbouring pairs, whose errors are alike, do not count as independent. Empty: fewer than
/// five seconds, or all angles are the same.
std::optional<AngleFit> FitAngles(const std::vector<AnglePair>& pairs);

/// Why factor or offset are not to be used, for a person. Empty: they are. No turn: the sensor's
/// angles spread over less than 15 degrees; no straight: less than 5 s of it; a line that fits
/// badly: scatter over 1 degree, or standard deviations over 0.02 of the factor or 0.2 degrees.
std::vector<std::string> JudgeAngles(const AngleFit& fit);

}  // namespace hitchview::calib
