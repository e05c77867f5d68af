#include <array>

#include "app/config_sections.hpp"

namespace hitchview::app {
namespace {

using calib::Choice;
using calib::Range;
using calib::YamlMap;
using calib::YamlValue;
using Source = CameraConfig::Source;

struct Flip {
    bool horizontal = false;
    bool vertical = false;
};
constexpr std::array kFlips{Choice<Flip>{"none", {}}, Choice<Flip>{"horizontal", {true, false}},
                            Choice<Flip>{"vertical", {false, true}},
                            Choice<Flip>{"both", {true, true}}};
/// What the drivers take; `best` leaves the choice to them.
constexpr std::array kV4l2Formats{
    Choice<const char*>{"best", "best"}, Choice<const char*>{"nv12", "nv12"},
    Choice<const char*>{"nm12", "nm12"}, Choice<const char*>{"uyvy", "uyvy"},
    Choice<const char*>{"yuyv", "yuyv"}, Choice<const char*>{"mjpeg", "mjpeg"},
    Choice<const char*>{"grey", "grey"}};
constexpr std::array kLibcameraFormats{
    Choice<const char*>{"best", "best"},     Choice<const char*>{"nv12", "nv12"},
    Choice<const char*>{"uyvy", "uyvy"},     Choice<const char*>{"yuyv", "yuyv"},
    Choice<const char*>{"rgb888", "rgb888"}, Choice<const char*>{"bgr888", "bgr888"},
    Choice<const char*>{"grey", "grey"}};

std::vector<ControlConfig> ReadControls(const YamlValue& value) {
    std::vector<ControlConfig> controls;
    YamlMap map = value.Map();
    for (const std::string& name : map.keys()) {
        ControlConfig control{.name = name, .value = {}};
        map[name].Read(control.value);
        controls.push_back(control);
    }
    map.Finish();
    return controls;
}

/// What every live camera has.
LiveCameraConfig ReadLive(YamlMap& source) {
    LiveCameraConfig live;
    ReadSize(source["size_px"], {64, 4096, true}, {64, 4096, true}, live.size_px);
    source["buffers"].Read(Range<int>{2, 32}, live.buffers);
    const YamlValue rotation = source["rotation_deg"];
    rotation.Read(Range<int>{0, 180}, live.rotation_deg);
    if (live.rotation_deg % 180 != 0) rotation.Refuse("0 or 180");
    Flip flip;
    source["flip"].Read(kFlips, flip);
    live.horizontal_flip = flip.horizontal;
    live.vertical_flip = flip.vertical;
    live.controls = ReadControls(source["controls"]);
    return live;
}

void ReadV4l2(const YamlValue& v4l2, YamlMap& source, CameraConfig& camera) {
    camera.source = Source::kV4l2;
    camera.live = ReadLive(source);
    const char* format = "best";
    source["format"].Read(kV4l2Formats, format);
    camera.live.format = format;
    source["input"].Read(Range<int>{0, 63}, camera.live.input);
    v4l2.Read(camera.live.device);
    if (!camera.live.device.empty() && camera.live.device.front() != '/')
        v4l2.Refuse("the absolute path of a device, best one of /dev/v4l/by-path");
}

void ReadLibcamera(const YamlValue& libcamera, YamlMap& source, CameraConfig& camera) {
    camera.source = Source::kLibcamera;
    camera.live = ReadLive(source);
    const char* format = "best";
    source["format"].Read(kLibcameraFormats, format);
    camera.live.format = format;
    source["accept_granted_size"].Read(camera.live.accept_granted_size);
    libcamera.Read(camera.live.device);
    if (camera.live.device.empty())
        libcamera.Refuse("the id of a camera, as `cam --list` writes it in brackets");
}

/// A map with exactly one of the keys that say where the frames come from; more beside a live one.
void ReadCameraSource(const YamlValue& value, ConfigContext& context, CameraConfig& camera) {
    YamlMap map = value.Map();
    const YamlValue simulated = map["simulated"];
    const YamlValue replay = map["replay"];
    const YamlValue v4l2 = map["v4l2"];
    const YamlValue libcamera = map["libcamera"];
    if (simulated.given() + replay.given() + v4l2.given() + libcamera.given() != 1)
        value.Refuse("a map with exactly one of simulated, replay, v4l2 and libcamera");
    ReadTrue(simulated);
    ReadPath(replay, context, camera.replay);
    if (v4l2.given()) {
        ReadV4l2(v4l2, map, camera);
    } else if (libcamera.given()) {
        ReadLibcamera(libcamera, map, camera);
    } else if (simulated.given()) {
        camera.source = Source::kSimulated;
        ++context.simulated_cameras;
    }
    map.Finish();
}

}  // namespace

CameraConfig ReadCamera(const YamlValue& value, ConfigContext& context) {
    CameraConfig camera;
    YamlMap map = value.Map();
    const YamlValue name = map.Required("name");
    name.Read(camera.name);
    if (!camera.name.empty() && !calib::IsName(camera.name)) {
        name.Refuse("letters, digits and _ only");
    } else if (!camera.name.empty() && !context.camera_names.insert(camera.name).second) {
        name.Refuse("unique in the rig");
    }
    const YamlValue source = map.Required("source");
    ReadCameraSource(source, context, camera);
    const std::string& device = camera.live.device;
    if (!device.empty() && !context.devices.insert(device).second)
        source.Refuse("a device of its own");
    ++(camera.IsLive() ? context.live_cameras : context.recorded_cameras);
    map.Finish();
    return camera;
}

}  // namespace hitchview::app
