#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

namespace hitchview::app {

/// Decodes a JPEG from the network into a BGR picture. False, and `bgr` as it was: it is not a
/// whole JPEG of exactly `size_px`; nothing is allocated for what the file itself claims.
bool DecodeJpeg(std::span<const std::uint8_t> jpeg, cv::Size size_px, cv::Mat& bgr);

}  // namespace hitchview::app
