#include <nlohmann/json.hpp>

#include "app/camera_table.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

/// Devices fill their names with any bytes, and cut them off anywhere.
json Text(const std::string& text) {
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
}

json SizeJson(const Size& size) {
    return {size.width_px, size.height_px};
}

json SizesJson(const OfferedSizes& sizes) {
    json rates = json::array();
    for (const OfferedRates& each : sizes.rates)
        rates.push_back({{"slowest_hz", each.slowest_hz}, {"fastest_hz", each.fastest_hz}});
    return {{"smallest_px", SizeJson(sizes.smallest)},
            {"largest_px", SizeJson(sizes.largest)},
            {"rates", rates}};
}

json FormatJson(const OfferedFormat& format) {
    json sizes = json::array();
    for (const OfferedSizes& each : format.sizes) sizes.push_back(SizesJson(each));
    return {{"fourcc", Text(format.fourcc)},
            {"format", format.name.empty() ? json(nullptr) : json(format.name)},
            {"description", Text(format.description)},
            {"sizes", sizes}};
}

json PickJson(const std::optional<CameraPick>& pick) {
    if (!pick) return nullptr;
    return {{"format", pick->format},
            {"size_px", SizeJson(pick->size_px)},
            {"rate_hz", pick->rate_hz},
            {"by_name", pick->by_name},
            {"others", pick->others}};
}

json SpeedJson(const std::optional<ReadSpeed>& speed) {
    if (!speed) return nullptr;
    return {{"buffer_gb_per_s", speed->buffer_gb_per_s},
            {"ordinary_gb_per_s", speed->ordinary_gb_per_s}};
}

json DeviceJson(const CameraDevice& device) {
    json formats = json::array();
    for (const OfferedFormat& format : device.formats) formats.push_back(FormatJson(format));
    json names = json::array();
    for (const std::string& name : device.names) names.push_back(Text(name));
    return {{"device", device.path},
            {"names", names},
            {"driver", Text(device.driver)},
            {"card", Text(device.card)},
            {"bus", Text(device.bus)},
            {"state", ToString(device.state)},
            {"refusal", Text(device.refusal)},
            {"remedy", Remedy(device)},
            {"time_stamps", ToString(device.stamps)},
            {"formats", formats},
            {"pick", PickJson(device.pick)},
            {"no_pick", Text(device.no_pick)},
            {"unsettable", Text(device.unsettable)},
            {"read_speed", SpeedJson(device.speed)},
            {"not_measured", Text(device.not_measured)}};
}

}  // namespace

json CamerasJson(const std::vector<CameraDevice>& devices) {
    json list = json::array();
    for (const CameraDevice& device : devices) list.push_back(DeviceJson(device));
    return list;
}

json MatchesJson(const std::vector<CameraMatch>& matches) {
    json list = json::array();
    for (const CameraMatch& match : matches) {
        list.push_back({{"unit", algo::ToString(match.unit)},
                        {"camera", match.name},
                        {"configured", Text(match.configured)},
                        {"device", match.device.empty() ? json(nullptr) : json(match.device)},
                        {"checked", match.looked_for},
                        {"problem", Text(match.problem)}});
    }
    return list;
}

}  // namespace hitchview::app
