#pragma once

#include <opencv2/core/mat.hpp>

#include "drivers/lcm_log_messages.hpp"

namespace hitchview::app {

/// The pixels of a logged image as 8-bit BGR of its size; from MJPG, UYVY, YUYV, NV12 and GREY.
/// Empty if it is of another format or damaged. BT.601, as in JPEG.
cv::Mat PictureOf(const drivers::LoggedImage& image);

}  // namespace hitchview::app
