#include "app/live_camera_options.hpp"

namespace hitchview::app {
namespace {

template <typename Wish>
std::vector<Wish> WishesFor(const std::vector<ControlConfig>& controls) {
    std::vector<Wish> wishes;
    for (const ControlConfig& control : controls) wishes.push_back({control.name, control.value});
    return wishes;
}

}  // namespace

drivers::V4l2CameraOptions V4l2OptionsOf(const std::string& name, const LiveCameraConfig& live,
                                         double rate_hz, int buffers) {
    drivers::V4l2CameraOptions options;
    options.name = name;
    options.path = live.device;
    options.wish = {{live.size_px.width_px, live.size_px.height_px}, rate_hz, live.format};
    options.buffers = buffers;
    options.input = live.input;
    options.orientation = {live.rotation_deg, live.horizontal_flip, live.vertical_flip};
    options.controls = WishesFor<drivers::V4l2ControlWish>(live.controls);
    return options;
}

drivers::LibcameraOptions LibcameraOptionsOf(const std::string& name, const LiveCameraConfig& live,
                                             double rate_hz, int buffers) {
    drivers::LibcameraOptions options;
    options.name = name;
    options.id = live.device;
    options.width_px = live.size_px.width_px;
    options.height_px = live.size_px.height_px;
    options.accept_granted_size = live.accept_granted_size;
    options.rate_hz = rate_hz;
    options.format = live.format;
    options.buffers = buffers;
    options.rotation_deg = live.rotation_deg;
    options.horizontal_flip = live.horizontal_flip;
    options.vertical_flip = live.vertical_flip;
    options.controls = WishesFor<drivers::LibcameraControlWish>(live.controls);
    return options;
}

}  // namespace hitchview::app
