#include "drivers/v4l2_settings.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace hitchview::drivers {
namespace {

bool IsUnsupported(const V4l2Result<hal::Done>& outcome) {
    return !outcome && outcome.error().error == hal::Error::kUnsupported;
}

std::uint32_t TotalWidth(const v4l2_bt_timings& t) {
    return t.width + t.hfrontporch + t.hsync + t.hbackporch;
}

std::uint32_t TotalHeight(const v4l2_bt_timings& t) {
    return t.height + t.vfrontporch + t.vsync + t.vbackporch;
}

/// What makes one timing different from another; the rest is padding. The blanking is among it:
/// 1280x720 has one pixel clock at 25, 30, 50 and 60 Hz.
bool SameTimings(const v4l2_dv_timings& a, const v4l2_dv_timings& b) {
    return a.bt.width == b.bt.width && a.bt.height == b.bt.height &&
           a.bt.interlaced == b.bt.interlaced && a.bt.pixelclock == b.bt.pixelclock &&
           TotalWidth(a.bt) == TotalWidth(b.bt) && TotalHeight(a.bt) == TotalHeight(b.bt);
}

bool IsInterlaced(std::uint32_t field) {
    return field != V4L2_FIELD_NONE && field != V4L2_FIELD_ANY;
}

v4l2_fract IntervalOf(double rate_hz) {
    constexpr std::uint32_t kParts = 1000;
    const auto denominator = static_cast<std::uint32_t>(std::lround(rate_hz * kParts));
    const std::uint32_t common = std::gcd(kParts, denominator);
    return {kParts / common, denominator / common};
}

v4l2_format RequestSingle(const V4l2FormatRequest& request) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    v4l2_pix_format& pix = format.fmt.pix;
    pix.width = static_cast<std::uint32_t>(request.width_px);
    pix.height = static_cast<std::uint32_t>(request.height_px);
    pix.pixelformat = request.fourcc;
    pix.field = V4L2_FIELD_NONE;
    pix.bytesperline = static_cast<std::uint32_t>(request.line_bytes);
    return format;
}

v4l2_format RequestMulti(const V4l2FormatRequest& request) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
    v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    pix.width = static_cast<std::uint32_t>(request.width_px);
    pix.height = static_cast<std::uint32_t>(request.height_px);
    pix.pixelformat = request.fourcc;
    pix.field = V4L2_FIELD_NONE;
    const V4l2PixelFormat* const known = FindV4l2PixelFormat(request.fourcc);
    pix.num_planes = static_cast<std::uint8_t>(known == nullptr ? 1 : known->memory_planes);
    for (std::size_t i = 0; i < pix.num_planes; ++i) {
        pix.plane_fmt[i].bytesperline = static_cast<std::uint32_t>(request.line_bytes);
    }
    return format;
}

V4l2Layout LayoutOf(const v4l2_pix_format& pix) {
    V4l2Layout layout;
    layout.fourcc = pix.pixelformat;
    layout.width_px = static_cast<int>(pix.width);
    layout.height_px = static_cast<int>(pix.height);
    layout.planes[0] = {static_cast<int>(pix.bytesperline), pix.sizeimage};
    layout.range = RangeOf(pix.pixelformat, pix.quantization, pix.colorspace);
    layout.interlaced = IsInterlaced(pix.field);
    return layout;
}

V4l2Layout LayoutOf(const v4l2_pix_format_mplane& pix) {
    V4l2Layout layout;
    layout.fourcc = pix.pixelformat;
    layout.width_px = static_cast<int>(pix.width);
    layout.height_px = static_cast<int>(pix.height);
    layout.memory_planes = std::clamp<int>(pix.num_planes, 1, 3);
    for (std::size_t i = 0; i < static_cast<std::size_t>(layout.memory_planes); ++i) {
        layout.planes[i] = {static_cast<int>(pix.plane_fmt[i].bytesperline),
                            pix.plane_fmt[i].sizeimage};
    }
    layout.range = RangeOf(pix.pixelformat, pix.quantization, pix.colorspace);
    layout.interlaced = IsInterlaced(pix.field);
    return layout;
}

/// Some drivers leave the length of a line open, which means that there is no padding.
void FillLineBytes(V4l2Layout& layout) {
    const V4l2PixelFormat* const format = FindV4l2PixelFormat(layout.fourcc);
    if (format == nullptr || format->line_bytes_per_pixel == 0) return;
    const std::int64_t tight = std::int64_t{layout.width_px} * format->line_bytes_per_pixel;
    for (V4l2Layout::MemoryPlane& plane : layout.planes) {
        if (plane.line_bytes == 0) plane.line_bytes = static_cast<int>(tight);
    }
}

}  // namespace

V4l2Result<V4l2Input> SelectInput(const V4l2Device& device, int input) {
    int selected = input;
    const auto chosen = input < 0 ? device.Call(VIDIOC_G_INPUT, "VIDIOC_G_INPUT", selected)
                                  : device.Call(VIDIOC_S_INPUT, "VIDIOC_S_INPUT", selected);
    if (input < 0 && IsUnsupported(chosen)) return V4l2Input{};
    if (!chosen) return chosen.error();
    v4l2_input description{};
    description.index = static_cast<std::uint32_t>(selected);
    if (const auto told = device.Call(VIDIOC_ENUMINPUT, "VIDIOC_ENUMINPUT", description); !told) {
        return told.error();
    }
    const bool timings = (description.capabilities & V4L2_IN_CAP_DV_TIMINGS) != 0;
    const bool standard = (description.capabilities & V4L2_IN_CAP_STD) != 0;
    return V4l2Input{timings, timings || standard};
}

V4l2Result<hal::Done> FollowTimings(const V4l2Device& device) {
    v4l2_dv_timings seen{};
    if (const auto told = device.Call(VIDIOC_QUERY_DV_TIMINGS, "VIDIOC_QUERY_DV_TIMINGS", seen);
        !told) {
        // ENOLINK, ENOLCK, ERANGE: nothing plugged in, not locked, out of range.
        if (told.error().error == hal::Error::kDisconnected) return told.error();
        return V4l2Failure{hal::Error::kNotFound, told.error().call, told.error().error_number};
    }
    v4l2_dv_timings current{};
    if (const auto told = device.Call(VIDIOC_G_DV_TIMINGS, "VIDIOC_G_DV_TIMINGS", current); !told) {
        return told.error();
    }
    if (SameTimings(seen, current)) return hal::Done{};
    return device.Call(VIDIOC_S_DV_TIMINGS, "VIDIOC_S_DV_TIMINGS", seen);
}

V4l2Result<hal::Done> SubscribeSourceChange(const V4l2Device& device) {
    v4l2_event_subscription subscription{};
    subscription.type = V4L2_EVENT_SOURCE_CHANGE;
    return device.Call(VIDIOC_SUBSCRIBE_EVENT, "VIDIOC_SUBSCRIBE_EVENT", subscription);
}

bool TakeSourceChange(const V4l2Device& device) {
    bool changed = false;
    v4l2_event event{};
    event.pending = 1;
    while (event.pending > 0 && device.Call(VIDIOC_DQEVENT, "VIDIOC_DQEVENT", event)) {
        changed = changed || (event.type == V4L2_EVENT_SOURCE_CHANGE &&
                              (event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION) != 0);
    }
    return changed;
}

V4l2Result<V4l2Layout> SetFormat(const V4l2Device& device, const V4l2FormatRequest& request) {
    v4l2_format format = device.multi_planar() ? RequestMulti(request) : RequestSingle(request);
    if (const auto set = device.Call(VIDIOC_S_FMT, "VIDIOC_S_FMT", format); !set)
        return set.error();
    V4l2Layout layout =
        device.multi_planar() ? LayoutOf(format.fmt.pix_mp) : LayoutOf(format.fmt.pix);
    FillLineBytes(layout);
    return layout;
}

V4l2Result<std::optional<double>> SetRate(const V4l2Device& device, double rate_hz) {
    v4l2_streamparm parameters{};
    parameters.type = device.buffer_type();
    const auto asked = device.Call(VIDIOC_G_PARM, "VIDIOC_G_PARM", parameters);
    if (IsUnsupported(asked)) return std::optional<double>{};
    if (!asked) return asked.error();
    if ((parameters.parm.capture.capability & V4L2_CAP_TIMEPERFRAME) == 0) {
        return std::optional<double>{};
    }
    parameters.parm.capture.timeperframe = IntervalOf(rate_hz);
    if (const auto set = device.Call(VIDIOC_S_PARM, "VIDIOC_S_PARM", parameters); !set)
        return set.error();
    const v4l2_fract& got = parameters.parm.capture.timeperframe;
    if (got.numerator == 0) return std::optional<double>{};
    return std::optional(static_cast<double>(got.denominator) / got.numerator);
}

V4l2Result<hal::Done> StartStream(const V4l2Device& device) {
    auto type = static_cast<int>(device.buffer_type());
    return device.Call(VIDIOC_STREAMON, "VIDIOC_STREAMON", type);
}

V4l2Result<hal::Done> StopStream(const V4l2Device& device) {
    auto type = static_cast<int>(device.buffer_type());
    return device.Call(VIDIOC_STREAMOFF, "VIDIOC_STREAMOFF", type);
}

}  // namespace hitchview::drivers
