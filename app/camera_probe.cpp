#include "app/camera_probe.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "app/live_camera_options.hpp"
#include "drivers/v4l2_camera.hpp"
#include "drivers/v4l2_probe.hpp"

namespace hitchview::app {
namespace {

using drivers::V4l2DeviceReport;
using drivers::V4l2FormatOffer;
using drivers::V4l2Wish;

drivers::V4l2CameraOptions OptionsOf(const std::string& path, const CameraWish& wish) {
    constexpr int kBuffers = 8;
    return V4l2OptionsOf(path, wish.live, wish.rate_hz, kBuffers);
}

OfferedSizes ToOffered(const drivers::V4l2Sizes& sizes) {
    OfferedSizes offered{
        {sizes.min_width_px, sizes.min_height_px}, {sizes.max_width_px, sizes.max_height_px}, {}};
    for (const drivers::V4l2Rates& rates : sizes.rates)
        offered.rates.push_back({rates.slowest_hz, rates.fastest_hz});
    return offered;
}

OfferedFormat ToOffered(const V4l2FormatOffer& offer) {
    const drivers::V4l2PixelFormat* format = drivers::FindV4l2PixelFormat(offer.fourcc);
    OfferedFormat offered{drivers::FourccText(offer.fourcc),
                          format == nullptr ? "" : format->name,
                          offer.description,
                          {}};
    for (const drivers::V4l2Sizes& sizes : offer.sizes) offered.sizes.push_back(ToOffered(sizes));
    return offered;
}

CameraDevice::State StateOf(const V4l2DeviceReport& report) {
    using State = CameraDevice::State;
    const int number = report.refusal_number;
    if (number == EACCES || number == EPERM) return State::kForbidden;
    if (report.busy || number == EBUSY) return State::kBusy;
    return report.refusal.empty() ? State::kFree : State::kRefused;
}

CameraDevice::Stamps StampsOf(const V4l2DeviceReport& report) {
    using Stamps = CameraDevice::Stamps;
    if (!report.stamps_known) return Stamps::kUnknown;
    switch (report.stamps) {
        case drivers::V4l2StampSource::kStartOfExposure:
            return Stamps::kStartOfExposure;
        case drivers::V4l2StampSource::kEndOfFrame:
            return Stamps::kEndOfFrame;
        case drivers::V4l2StampSource::kDequeue:
            break;
    }
    return Stamps::kNotMonotonic;
}

std::vector<std::string> FormatsThatDo(const std::vector<V4l2FormatOffer>& offers, V4l2Wish wish) {
    std::vector<std::string> names;
    for (const drivers::V4l2PixelFormat& format : drivers::V4l2PixelFormats()) {
        wish.format = format.name;
        if (drivers::ChooseFormat(offers, wish)) names.emplace_back(format.name);
    }
    return names;
}

void Pick(const V4l2DeviceReport& report, const CameraWish& wish, CameraDevice& device) {
    const drivers::V4l2CameraOptions options = OptionsOf(device.path, wish);
    if (const auto settings = drivers::CheckSettings(report, options); !settings)
        device.unsettable = settings.error();
    const auto& [live, rate_hz] = wish;
    const auto chosen = drivers::ChooseFormat(report.offers, options.wish);
    if (!chosen) {
        device.no_pick = "wanted " + SizeText(live.size_px) + " at " + RateText(rate_hz) +
                         " Hz as " + live.format + ", which it does not offer";
        return;
    }
    CameraPick pick{chosen.value()->name, live.size_px, rate_hz, live.format != "best", {}};
    pick.others = FormatsThatDo(report.offers, options.wish);
    std::erase(pick.others, pick.format);
    device.pick = std::move(pick);
}

CameraWish WishFor(const CameraDevice& device, const std::vector<CameraWish>& wishes) {
    const auto own = std::ranges::find_if(
        wishes, [&](const CameraWish& wish) { return device.IsNamed(wish.live.device); });
    return own == wishes.end() ? CameraWish{} : *own;
}

CameraDevice ToDevice(const V4l2DeviceReport& report, const std::vector<CameraWish>& wishes) {
    CameraDevice device;
    device.path = report.path;
    device.names = report.links;
    device.driver = report.driver;
    device.card = report.card;
    device.bus = report.bus;
    device.state = StateOf(report);
    device.refusal = report.refusal;
    device.stamps = StampsOf(report);
    for (const V4l2FormatOffer& offer : report.offers) device.formats.push_back(ToOffered(offer));
    if (report.refusal.empty()) Pick(report, WishFor(device, wishes), device);
    return device;
}

void Measure(CameraDevice& device) {
    if (!device.pick) return;
    if (device.state == CameraDevice::State::kBusy) {
        device.not_measured = "not measured: a program streams from it";
        return;
    }
    CameraWish wish{{}, device.pick->rate_hz};
    wish.live.device = device.path;
    wish.live.size_px = device.pick->size_px;
    wish.live.format = device.pick->format;
    const auto camera = drivers::V4l2Camera::Open(OptionsOf(device.path, wish));
    if (!camera) {
        device.not_measured = camera.error();
        return;
    }
    const drivers::V4l2CameraFacts& facts = camera.value()->facts();
    device.speed = ReadSpeed{facts.buffer_read_gb_per_s, facts.ordinary_read_gb_per_s};
}

}  // namespace

std::vector<CameraDevice> ProbeCameras(const std::vector<CameraWish>& wishes,
                                       CameraMeasure measure) {
    const CameraWish first = wishes.empty() ? CameraWish{} : wishes.front();
    std::vector<CameraDevice> devices;
    for (const V4l2DeviceReport& report : drivers::ProbeV4l2Devices(
             drivers::V4l2LinkFolders(), drivers::SystemKernel(), OptionsOf("", first).wish.size)) {
        devices.push_back(ToDevice(report, wishes));
        if (measure == CameraMeasure::kReadSpeed) Measure(devices.back());
    }
    return devices;
}

}  // namespace hitchview::app
