#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2_device.hpp"
#include "drivers/v4l2_format.hpp"
#include "hal/result.hpp"

namespace hitchview::drivers {

/// Frame rates from `slowest_hz` to `fastest_hz`; the same twice: one rate.
struct V4l2Rates {
    double slowest_hz = 0;
    double fastest_hz = 0;
};

/// Sizes in steps from the smallest to the largest; the same twice: one size.
struct V4l2Sizes {
    int min_width_px = 0;
    int max_width_px = 0;
    int step_width_px = 1;
    int min_height_px = 0;
    int max_height_px = 0;
    int step_height_px = 1;
    std::vector<V4l2Rates> rates;  ///< empty: the device does not tell
};

struct V4l2FormatOffer {
    std::uint32_t fourcc = 0;
    std::string description;
    std::vector<V4l2Sizes> sizes;  ///< empty: the device does not tell
};

struct V4l2Size {
    int width_px = 0;
    int height_px = 0;
};

/// Everything the device lists, by enumeration, in its own order; of drivers whose lists never end
/// at most 256 formats, 64 sizes of each and 64 rates of these. Of sizes that are a range, the
/// rates are those at `wanted`, or at the largest where `wanted` is not in it. Set-up only.
std::vector<V4l2FormatOffer> ListOffers(const V4l2Device& device, V4l2Size wanted);

/// Names of the inputs, by number, at most 64; empty: the device has no such choice. Set-up only.
std::vector<std::string> ListInputs(const V4l2Device& device);

/// "UYVY 640x480 at 30, 15 Hz; YUYV 16x16..1920x1080"; what this driver does not take, left out.
std::string OffersText(const std::vector<V4l2FormatOffer>& offers);

/// What a configuration asks of a camera.
struct V4l2Wish {
    V4l2Size size;
    double rate_hz = 0;
    std::string format = "best";  ///< name of a V4l2PixelFormat, or best
};

/// The format asked for, or with `best` the first of V4l2PixelFormats() that is offered in this
/// size at this rate. A rate is met within 1 %. The error names what was wanted and what is
/// offered. Pure.
hal::Checked<const V4l2PixelFormat*> ChooseFormat(const std::vector<V4l2FormatOffer>& offers,
                                                  const V4l2Wish& wish);

/// Within 1 %: 29.97 is 30.
bool SameRate(double a_hz, double b_hz);

/// "1280x720".
std::string SizeText(V4l2Size size);

/// 30 -> "30", 29.97 -> "29.97".
std::string RateText(double rate_hz);

}  // namespace hitchview::drivers
