#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

namespace hitchview::app {

/// Text that may stand between tags and in quoted attributes: & < > " ' and control characters are
/// replaced.
std::string Escaped(const std::string& text);

/// With so many digits behind the point; never "-0".
std::string Number(double value, int decimals);

/// RFC 4648, with padding.
std::string Base64(std::span<const std::uint8_t> bytes);

/// <figure> of a picture (BGR or grey) that the file itself holds, as a JPEG. `caption` is text.
std::string Figure(const cv::Mat& picture, const std::string& caption);

}  // namespace hitchview::app
