#include "app/live_opening.hpp"

#include <algorithm>

#include "app/live_camera_options.hpp"
#include "drivers/libcamera_camera.hpp"

namespace hitchview::app {
namespace {

int BuffersOf(const LiveCameraConfig& live, int slots, int taps) {
    constexpr int kWithTheDevice = 3;
    constexpr int kMost = 32;
    return live.buffers > 0 ? std::min(live.buffers + taps, kMost) : slots + kWithTheDevice;
}

}  // namespace

hal::Checked<hal::Done> LiveOpening::Add(const CameraConfig& camera) {
    const int buffers = BuffersOf(camera.live, slots_, taps_);
    Opened& place = opened_.emplace_back();
    if (camera.source == CameraConfig::Source::kLibcamera) {
        auto opened =
            drivers::OpenLibcamera(LibcameraOptionsOf(camera.name, camera.live, rate_hz_, buffers));
        if (!opened) return opened.error();
        place.camera = std::move(*opened);
        return hal::Done{};
    }
    place.options = V4l2OptionsOf(camera.name, camera.live, rate_hz_, buffers);
    auto opened = drivers::V4l2Camera::TryOpen(place.options);
    if (!opened) place.refusal = opened.error();
    if (!opened && place.refusal.is_wish_wrong) return place.refusal.words;
    if (!opened) return hal::Done{};
    place.v4l2 = opened->get();
    place.camera = std::move(*opened);
    return hal::Done{};
}

std::vector<std::size_t> LiveOpening::Absent() const {
    std::vector<std::size_t> absent;
    for (std::size_t i = 0; i < opened_.size(); ++i)
        if (!opened_[i].camera) absent.push_back(i);
    return absent;
}

void LiveOpening::AwaitAbsent() {
    std::vector<const drivers::V4l2Camera*> there;
    for (const Opened& opened : opened_)
        if (opened.v4l2 != nullptr) there.push_back(opened.v4l2);
    for (const std::size_t i : Absent()) {
        Opened& absent = opened_[i];
        absent.camera = drivers::V4l2Camera::Await(absent.options, absent.refusal.failure, there);
    }
}

}  // namespace hitchview::app
