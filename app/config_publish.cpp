#include <algorithm>
#include <cctype>

#include "app/config_sections.hpp"

namespace hitchview::app {
namespace {

using calib::Range;
using calib::YamlMap;
using calib::YamlValue;

constexpr std::size_t kMaxChannelLength = 63;  // LCM's own limit
constexpr std::size_t kMaxViewports = 8;

void ReadChannel(const YamlValue& value, std::set<std::string>& channels, std::string& out) {
    value.Read(out);
    if (!calib::IsName(out) || out.size() > kMaxChannelLength) {
        value.Refuse("an LCM channel: letters, digits and _, at most 63 characters");
    } else if (!channels.insert(out).second) {
        value.Refuse("a channel of its own");
    }
}

template <typename T>
void ReadPair(const YamlValue& value, const Range<T>& range, std::optional<std::array<T, 2>>& out) {
    if (!value.given()) return;
    std::array<T, 2> pair{};
    value.Read(range, pair);
    out = pair;
}

/// A length that begins before it ends.
void ReadSpan(const YamlValue& value, std::optional<std::array<int, 2>>& out) {
    ReadPair(value, Range<int>{0, 8192}, out);
    if (out && (*out)[0] >= (*out)[1]) value.Refuse("two numbers, the first smaller");
}

void ReadColumns(YamlMap& map, bool ring, ViewportConfig& viewport) {
    const YamlValue azimuth = map["azimuth_deg"];
    const YamlValue columns = map["columns_px"];
    ReadPair(azimuth, Range<double>{-360, 360}, viewport.azimuth_deg);
    ReadSpan(columns, viewport.columns_px);
    if (!ring) azimuth.Refuse("absent with projection plane");
    if (azimuth.given() && columns.given()) columns.Refuse("absent beside azimuth_deg");
    if (azimuth.given() || columns.given()) return;
    std::array<double, 2> missing{};
    map.Required(ring ? "azimuth_deg" : "columns_px").Read(Range<double>{-360, 360}, missing);
}

ViewportConfig ReadViewport(const YamlValue& value, bool ring, int max_bytes,
                            std::set<std::string>& channels) {
    ViewportConfig viewport;
    YamlMap map = value.Map();
    const YamlValue name = map.Required("name");
    name.Read(viewport.name);
    viewport.channel = ChannelOf("VIEW_", viewport.name);
    if (!calib::IsName(viewport.name) || viewport.channel.size() > kMaxChannelLength) {
        name.Refuse("letters, digits and _, at most 58");
    } else if (!channels.insert(viewport.channel).second) {
        name.Refuse("a name of its own");
    }
    ReadColumns(map, ring, viewport);
    ReadSpan(map["rows_px"], viewport.rows_px);
    map["every"].Read(Range<int>{1, 300}, viewport.every);
    viewport.max_bytes = std::min(viewport.max_bytes, max_bytes);
    map["max_bytes"].Read(Range<int>{20000, max_bytes}, viewport.max_bytes);
    map.Finish();
    return viewport;
}

PreviewConfig ReadPreview(const YamlValue& value) {
    PreviewConfig preview;
    YamlMap map = value.Map();
    map["rate_hz"].Read({0, 5}, preview.rate_hz);
    map.Finish();
    return preview;
}

OverlayConfig ReadOverlay(const YamlValue& value, std::set<std::string>& channels) {
    OverlayConfig overlay;
    YamlMap map = value.Map();
    ReadChannel(map["channel"], channels, overlay.channel);
    map["rate_hz"].Read({0, 5}, overlay.rate_hz);
    map.Finish();
    return overlay;
}

}  // namespace

std::string ChannelOf(const std::string& prefix, const std::string& name) {
    std::string channel = prefix + name;
    std::ranges::transform(channel, channel.begin(), [](unsigned char letter) {
        return static_cast<char>(std::toupper(letter));
    });
    return channel;
}

PublishConfig ReadPublish(const YamlValue& value, bool ring) {
    PublishConfig publish;
    YamlMap map = value.Map();
    map["url"].Read(publish.url);
    std::set<std::string> channels;
    ReadChannel(map["panorama_channel"], channels, publish.panorama_channel);
    ReadChannel(map["status_channel"], channels, publish.status_channel);
    ReadChannel(map["hitch_angle_channel"], channels, publish.hitch_angle_channel);
    ReadChannel(map["event_channel"], channels, publish.event_channel);
    ReadChannel(map["health_channel"], channels, publish.health_channel);
    map["jpeg_quality"].Read(Range<int>{30, 95}, publish.jpeg_quality);
    map["max_bytes"].Read(Range<int>{20000, 4000000}, publish.max_bytes);
    map["fit_receive_buffer"].Read(publish.fit_receive_buffer);
    const YamlValue viewports = map["viewports"];
    if (viewports.given()) {
        for (const YamlValue& viewport : viewports.List({0, kMaxViewports}))
            publish.viewports.push_back(ReadViewport(viewport, ring, publish.max_bytes, channels));
    }
    publish.preview = ReadPreview(map["preview"]);
    publish.overlay = ReadOverlay(map["overlay"], channels);
    map.Finish();
    return publish;
}

}  // namespace hitchview::app
