#include "drivers/v4l2_controls.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>

namespace hitchview::drivers {
namespace {

constexpr std::uint32_t kNextControl = V4L2_CTRL_FLAG_NEXT_CTRL;
constexpr std::size_t kMostControls = 1024;

/// v4l2-ctl's way to write names: small letters and digits, one _ for everything in between.
std::string PlainName(const std::string& name) {
    std::string plain;
    for (const char letter : name) {
        const auto code = static_cast<unsigned char>(letter);
        if (std::isalnum(code) != 0) {
            plain += static_cast<char>(std::tolower(code));
        } else if (!plain.empty() && plain.back() != '_') {
            plain += '_';
        }
    }
    if (!plain.empty() && plain.back() == '_') plain.pop_back();
    return plain;
}

std::optional<std::int64_t> Number(const std::string& text) {
    const bool hex = text.starts_with("0x");
    const char* const first = text.data() + (hex ? 2 : 0);
    const char* const end = text.data() + text.size();
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(first, end, value, hex ? 16 : 10);
    if (error != std::errc{} || stop != end || first == end) return std::nullopt;
    return value;
}

bool IsMenu(std::uint32_t type) {
    return type == V4L2_CTRL_TYPE_MENU || type == V4L2_CTRL_TYPE_INTEGER_MENU;
}

bool IsMenu(const V4l2Control& control) {
    return IsMenu(control.type);
}

void ListMenu(const V4l2Device& device, V4l2Control& control) {
    constexpr std::int64_t kMostEntries = 1024;
    v4l2_querymenu entry{};
    entry.id = control.id;
    const std::int64_t first = std::max<std::int64_t>(control.minimum, 0);
    const std::int64_t last = std::min(control.maximum, first + kMostEntries - 1);
    for (std::int64_t i = first; i <= last; ++i) {
        entry.index = static_cast<std::uint32_t>(i);
        if (!device.Call(VIDIOC_QUERYMENU, "VIDIOC_QUERYMENU", entry)) continue;
        const auto* text = reinterpret_cast<const char*>(entry.name);
        control.menu.emplace_back(i, control.type == V4L2_CTRL_TYPE_MENU
                                         ? FieldText({text, sizeof entry.name})
                                         : std::to_string(entry.value));
    }
}

V4l2Control ControlOf(const v4l2_query_ext_ctrl& query) {
    return {query.id,
            PlainName(FieldText(query.name)),
            query.type,
            query.minimum,
            query.maximum,
            query.step,
            query.default_value,
            query.flags,
            {}};
}

const V4l2Control* Find(const std::vector<V4l2Control>& controls, const std::string& wish) {
    const auto maybe_id = Number(wish);
    const std::string name = PlainName(wish);
    const auto found = std::ranges::find_if(controls, [&](const V4l2Control& control) {
        return maybe_id ? control.id == *maybe_id : control.name == name;
    });
    return found == controls.end() ? nullptr : &*found;
}

const V4l2Control* Find(const std::vector<V4l2Control>& controls, std::uint32_t id) {
    const auto found = std::ranges::find(controls, id, &V4l2Control::id);
    return found == controls.end() ? nullptr : &*found;
}

std::string Names(const std::vector<V4l2Control>& controls) {
    std::string names;
    for (const V4l2Control& control : controls) {
        names += (names.empty() ? "" : ", ") + control.name;
    }
    return names.empty() ? "none" : names;
}

std::string Allowed(const V4l2Control& control) {
    std::string text;
    for (const auto& [index, entry] : control.menu) {
        text += (text.empty() ? "one of " : ", ") + std::to_string(index) + " (" + entry + ")";
    }
    if (!text.empty()) return text;
    text = std::to_string(control.minimum) + " to " + std::to_string(control.maximum);
    return control.step > 1 ? text + " in steps of " + std::to_string(control.step) : text;
}

std::optional<std::int64_t> MenuIndex(const V4l2Control& control, const std::string& value) {
    const auto maybe_index = Number(value);
    for (const auto& [index, entry] : control.menu) {
        if (PlainName(entry) == PlainName(value) || maybe_index == index) return index;
    }
    return std::nullopt;
}

std::optional<std::int64_t> ValueIn(const V4l2Control& control, const std::string& value) {
    if (IsMenu(control)) return MenuIndex(control, value);
    const bool is_switch = control.type == V4L2_CTRL_TYPE_BOOLEAN;
    if (is_switch && value == "true") return 1;
    if (is_switch && value == "false") return 0;
    const auto maybe_value = Number(value);
    if (!maybe_value || *maybe_value < control.minimum || *maybe_value > control.maximum) {
        return std::nullopt;
    }
    const auto above =
        static_cast<std::uint64_t>(*maybe_value) - static_cast<std::uint64_t>(control.minimum);
    if (control.step > 1 && above % control.step != 0) return std::nullopt;
    return maybe_value;
}

bool IsSettable(std::uint32_t type, std::uint32_t flags) {
    const bool number = type == V4L2_CTRL_TYPE_INTEGER || type == V4L2_CTRL_TYPE_BOOLEAN ||
                        type == V4L2_CTRL_TYPE_INTEGER64 || IsMenu(type);
    return number && (flags & V4L2_CTRL_FLAG_READ_ONLY) == 0;
}

bool IsSettable(const V4l2Control& control) {
    return IsSettable(control.type, control.flags);
}

/// Each mirror, and whether the picture needs it.
std::array<std::pair<std::uint32_t, bool>, 2> MirrorsOf(const V4l2Orientation& orientation) {
    const bool turned = orientation.rotation_deg == 180;
    return {std::pair{std::uint32_t{V4L2_CID_HFLIP}, orientation.horizontal_flip != turned},
            std::pair{std::uint32_t{V4L2_CID_VFLIP}, orientation.vertical_flip != turned}};
}

/// One control of a device, if it has it.
std::optional<v4l2_query_ext_ctrl> Ask(const V4l2Device& device, std::uint32_t id) {
    v4l2_query_ext_ctrl query{};
    query.id = id;
    if (!device.Call(VIDIOC_QUERY_EXT_CTRL, "VIDIOC_QUERY_EXT_CTRL", query)) return std::nullopt;
    if ((query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return std::nullopt;
    return query;
}

hal::Checked<V4l2ControlValue> Plan(const std::vector<V4l2Control>& controls,
                                    const V4l2ControlWish& wish) {
    const V4l2Control* control = Find(controls, wish.control);
    if (control == nullptr) {
        return "control " + wish.control + " is not there; the device has " + Names(controls);
    }
    if (!IsSettable(*control)) {
        return "control " + control->name + " cannot be set to " + wish.value +
               ": it is read-only, or no number, switch or menu";
    }
    const auto maybe_value = ValueIn(*control, wish.value);
    if (!maybe_value) {
        return "control " + control->name + " is " + wish.value + ", must be " + Allowed(*control);
    }
    return V4l2ControlValue{control->id, *maybe_value, control->type == V4L2_CTRL_TYPE_INTEGER64};
}

}  // namespace

std::vector<V4l2Control> ListControls(const V4l2Device& device, V4l2Menus menus) {
    std::vector<V4l2Control> controls;
    v4l2_query_ext_ctrl query{};
    query.id = kNextControl;
    std::uint32_t before = 0;
    while (device.Call(VIDIOC_QUERY_EXT_CTRL, "VIDIOC_QUERY_EXT_CTRL", query)) {
        if (query.id <= before || controls.size() == kMostControls) break;
        before = query.id;
        const bool heading = query.type == V4L2_CTRL_TYPE_CTRL_CLASS;
        const bool disabled = (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0;
        if (!heading && !disabled) controls.push_back(ControlOf(query));
        query.id |= kNextControl;
    }
    if (menus == V4l2Menus::kLeftOut) return controls;
    for (V4l2Control& control : controls) {
        if (IsMenu(control)) ListMenu(device, control);
    }
    return controls;
}

hal::Checked<std::vector<V4l2ControlValue>> PlanControls(
    const std::vector<V4l2Control>& controls, const std::vector<V4l2ControlWish>& wishes) {
    std::vector<V4l2ControlValue> values;
    for (const V4l2ControlWish& wish : wishes) {
        const auto value = Plan(controls, wish);
        if (!value) return value.error();
        values.push_back(value.value());
    }
    return values;
}

hal::Checked<std::vector<V4l2ControlValue>> PlanOrientation(
    const std::vector<V4l2Control>& controls, const V4l2Orientation& orientation) {
    std::vector<V4l2ControlValue> values;
    for (const auto& [id, wanted] : MirrorsOf(orientation)) {
        const V4l2Control* mirror = Find(controls, id);
        if (mirror != nullptr && IsSettable(*mirror)) {
            values.push_back({mirror->id, wanted ? 1 : 0, false});
        } else if (wanted) {
            return std::string("the device cannot mirror the picture ") +
                   (id == V4L2_CID_HFLIP ? "horizontally" : "vertically") +
                   "; leave rotation and flips out and calibrate the camera as it is mounted: its "
                   "rotation in the calibration turns the picture (a mirror image alone it cannot "
                   "express)";
        }
    }
    return values;
}

hal::Checked<std::vector<V4l2ControlValue>> PlanSettings(
    const std::vector<V4l2Control>& controls, const V4l2Orientation& orientation,
    const std::vector<V4l2ControlWish>& wishes) {
    auto settings = PlanOrientation(controls, orientation);
    if (!settings) return settings;
    const auto values = PlanControls(controls, wishes);
    if (!values) return values.error();
    settings->insert(settings->end(), values.value().begin(), values.value().end());
    return settings;
}

V4l2Result<V4l2Mirrors> AskMirrors(const V4l2Device& device, const V4l2Orientation& orientation) {
    V4l2Mirrors mirrors;
    for (const auto& [id, wanted] : MirrorsOf(orientation)) {
        const auto mirror = Ask(device, id);
        if (mirror && IsSettable(mirror->type, mirror->flags))
            mirrors.values.at(mirrors.count++) = {id, wanted ? 1 : 0, false};
        else if (wanted)
            return V4l2Failure{hal::Error::kUnsupported, "it cannot mirror the picture", 0};
    }
    return mirrors;
}

V4l2Result<hal::Done> SetControl(const V4l2Device& device, const V4l2ControlValue& value) {
    v4l2_ext_control control{};
    control.id = value.id;
    if (value.wide) {
        control.value64 = value.value;
    } else {
        control.value = static_cast<std::int32_t>(value.value);
    }
    v4l2_ext_controls controls{};
    controls.which = V4L2_CTRL_WHICH_CUR_VAL;
    controls.count = 1;
    controls.controls = &control;
    return device.Call(VIDIOC_S_EXT_CTRLS, "VIDIOC_S_EXT_CTRLS", controls);
}

bool HasExposure(const std::vector<V4l2Control>& controls) {
    const V4l2Control* exposure = Find(controls, V4L2_CID_EXPOSURE_ABSOLUTE);
    return exposure != nullptr && (exposure->flags & V4L2_CTRL_FLAG_WRITE_ONLY) == 0;
}

bool AskExposure(const V4l2Device& device) {
    const auto exposure = Ask(device, V4L2_CID_EXPOSURE_ABSOLUTE);
    return exposure && (exposure->flags & V4L2_CTRL_FLAG_WRITE_ONLY) == 0;
}

std::optional<hal::Instant> ReadExposure(const V4l2Device& device) {
    constexpr std::chrono::microseconds kUnit{100};
    v4l2_control exposure{};
    exposure.id = V4L2_CID_EXPOSURE_ABSOLUTE;
    if (!device.Call(VIDIOC_G_CTRL, "VIDIOC_G_CTRL", exposure) || exposure.value <= 0)
        return std::nullopt;
    return exposure.value * kUnit;
}

}  // namespace hitchview::drivers
