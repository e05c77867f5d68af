#include "app/camera_table.hpp"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <utility>

#include "app/text_table.hpp"

namespace hitchview::app {
namespace {

constexpr std::size_t kBestSizes = 3;
constexpr std::size_t kBestRates = 3;

std::string Joined(const std::vector<std::string>& parts, const char* separator) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
    return text;
}

std::string PickText(const CameraDevice& device) {
    if (!device.pick) return "none";
    const CameraPick& pick = *device.pick;
    return pick.format + " " + SizeText(pick.size_px) + " at " + RateText(pick.rate_hz) + " Hz";
}

/// Why the driver prefers it to those that follow it.
std::string Virtue(const std::string& format) {
    if (format == "nv12" || format == "nm12") return "1.5 bytes a pixel, the least to read";
    if (format == "uyvy" || format == "yuyv") return "2 bytes a pixel, as they come";
    if (format == "grey") return "no colours, but nothing else is offered so";
    return "nothing uncompressed is offered so; each frame is decoded";
}

std::string WhyText(const CameraDevice& device, CameraDetail detail) {
    if (!device.pick)
        return device.no_pick +
               (detail == CameraDetail::kBest ? "; --all shows every size and rate" : "");
    const CameraPick& pick = *device.pick;
    const std::string why = pick.by_name ? "the rig file says so" : Virtue(pick.format);
    return pick.others.empty() ? why : why + "; would do too: " + Joined(pick.others, ", ");
}

std::string RangeText(const OfferedRates& rates) {
    const std::string fastest = RateText(rates.fastest_hz);
    return rates.slowest_hz == rates.fastest_hz ? fastest
                                                : RateText(rates.slowest_hz) + ".." + fastest;
}

std::string RatesText(std::vector<OfferedRates> rates, CameraDetail detail) {
    if (rates.empty()) return "";
    std::ranges::stable_sort(rates, std::ranges::greater{}, &OfferedRates::fastest_hz);
    const bool cut = detail == CameraDetail::kBest && rates.size() > kBestRates;
    if (cut) rates.resize(kBestRates);
    std::vector<std::string> texts;
    texts.reserve(rates.size());
    for (const OfferedRates& each : rates) texts.push_back(RangeText(each));
    return " at " + Joined(texts, ", ") + (cut ? ", .." : "") + " Hz";
}

std::string SizesText(const OfferedSizes& sizes, CameraDetail detail) {
    const std::string smallest = SizeText(sizes.smallest);
    const std::string largest = SizeText(sizes.largest);
    return (smallest == largest ? largest : smallest + ".." + largest) +
           RatesText(sizes.rates, detail);
}

/// The picked size, then the largest.
std::string SizesText(std::vector<OfferedSizes> sizes, const CameraDevice& device,
                      CameraDetail detail) {
    const auto rank = [&](const OfferedSizes& each) {
        const bool picked = device.pick && SizeText(device.pick->size_px) == SizeText(each.largest);
        return std::pair(picked, std::int64_t{each.largest.width_px} * each.largest.height_px);
    };
    std::ranges::stable_sort(sizes, std::ranges::greater{}, rank);
    std::size_t left_out = 0;
    if (detail == CameraDetail::kBest && sizes.size() > kBestSizes) {
        left_out = sizes.size() - kBestSizes;
        sizes.resize(kBestSizes);
    }
    std::vector<std::string> texts;
    texts.reserve(sizes.size() + 1);
    for (const OfferedSizes& each : sizes) texts.push_back(SizesText(each, detail));
    if (left_out > 0) texts.push_back("and " + std::to_string(left_out) + " more");
    return texts.empty() ? "any size" : Joined(texts, "; ");
}

struct Offer {
    std::string sizes;
    std::string formats;
};

/// Formats that are offered alike share one.
std::vector<Offer> Offers(const CameraDevice& device, CameraDetail detail) {
    std::vector<Offer> offers;
    for (const OfferedFormat& format : device.formats) {
        if (format.name.empty()) continue;
        const std::string sizes = SizesText(format.sizes, device, detail);
        const auto alike = std::ranges::find(offers, sizes, &Offer::sizes);
        if (alike == offers.end()) {
            offers.push_back({sizes, format.fourcc});
        } else {
            alike->formats += ", " + format.fourcc;
        }
    }
    return offers;
}

std::string NotTaken(const CameraDevice& device) {
    std::vector<std::string> fourccs;
    for (const OfferedFormat& format : device.formats) {
        if (format.name.empty()) fourccs.push_back(format.fourcc);
    }
    return fourccs.empty() ? "" : DetailLines("offers", "not taken here: " + Joined(fourccs, ", "));
}

std::string OffersText(const CameraDevice& device, CameraDetail detail) {
    std::string text;
    for (Offer& offer : Offers(device, detail))
        text += DetailLines("offers", offer.formats.append(": ").append(offer.sizes));
    return detail == CameraDetail::kAll ? text + NotTaken(device) : text;
}

std::string SpeedText(const ReadSpeed& speed) {
    const auto number = [](double gb_per_s) {
        std::ostringstream text;
        text.precision(3);
        text << gb_per_s;
        return text.str();
    };
    return number(speed.buffer_gb_per_s) + " GB/s from a buffer, " +
           number(speed.ordinary_gb_per_s) + " GB/s from ordinary memory";
}

std::string Details(const CameraDevice& device, CameraDetail detail) {
    std::string text;
    for (const std::string& name : device.names) text += DetailLines("name", name);
    if (!device.bus.empty()) text += DetailLines("bus", device.bus);
    if (!device.IsOpen())
        return text + DetailLines("why", device.refusal) + DetailLines("do", Remedy(device));
    text += OffersText(device, detail) + DetailLines("why", WhyText(device, detail));
    if (device.speed) text += DetailLines("speed", SpeedText(*device.speed));
    if (!device.not_measured.empty()) text += DetailLines("speed", device.not_measured);
    return text;
}

const char* StateOf(const CameraMatch& match) {
    if (!match.looked_for) return "not checked";
    if (match.problem.empty()) return "there";
    return match.device.empty() ? "MISSING" : "UNUSABLE";
}

}  // namespace

std::string CameraTable(const std::vector<CameraDevice>& devices, CameraDetail detail) {
    if (devices.empty()) {
        return "No camera: no /dev/video* of this machine captures.\n"
               "Check that it is plugged in and has power (lsusb, sudo dmesg), that its driver is\n"
               "loaded (USB: lsmod | grep uvcvideo), and in a container that the device is passed "
               "in.\n";
    }
    TextTable table({"DEVICE", "DRIVER", "CARD", "STATE", "TIME STAMPS", "PICK"});
    for (const CameraDevice& device : devices) {
        table.Add({device.path, device.driver, device.card, ToString(device.state),
                   ToString(device.stamps), PickText(device)},
                  Details(device, detail));
    }
    return table.Text();
}

std::string MatchTable(const std::vector<CameraMatch>& matches) {
    TextTable table({"UNIT", "CAMERA", "STATE", "DEVICE"});
    for (const CameraMatch& match : matches) {
        table.Add({algo::ToString(match.unit), match.name, StateOf(match),
                   match.device.empty() ? "none" : match.device},
                  DetailLines("name", match.configured) +
                      (match.problem.empty() ? "" : DetailLines("why", match.problem)));
    }
    return table.Text();
}

}  // namespace hitchview::app
