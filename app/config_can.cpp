#include <algorithm>
#include <array>
#include <cstdio>

#include "app/config_sections.hpp"
#include "app/dbc_signal.hpp"

namespace hitchview::app {
namespace {

using calib::Choice;
using calib::Range;
using calib::YamlMap;
using calib::YamlValue;

constexpr std::size_t kLongestInterface = 15;  // the kernel's IFNAMSIZ - 1
constexpr std::size_t kMaxQualities = 64;

constexpr std::array kByteOrders{Choice<CanByteOrder>{"motorola", CanByteOrder::kMotorola},
                                 Choice<CanByteOrder>{"intel", CanByteOrder::kIntel}};
constexpr std::array kUnits{Choice<const char*>{"degrees", "degrees"},
                            Choice<const char*>{"radians", "radians"}};
/// Ours is positive to the left.
constexpr std::array kSides{Choice<double>{"left", 1.0}, Choice<double>{"right", -1.0}};

/// What the keys of a hitch angle name in a DBC file.
struct DbcNames {
    std::string file{};  // as the rig file says it
    DbcFile dbc{};
    const DbcMessage* message = nullptr;
    const DbcSignal* signal = nullptr;
};

void ReadInterface(const YamlValue& value, std::string& interface) {
    if (!value.given()) return;
    value.Read(interface);
    const bool is_name = interface.size() <= kLongestInterface &&
                         interface.find_first_of("/ \t\n") == interface.npos;
    if (!is_name) value.Refuse("the name of a network interface, 1 to 15 characters, such as can0");
}

void ReadCanSource(const YamlValue& value, const ConfigContext& context, CanConfig& can) {
    YamlMap map = value.Map();
    const YamlValue simulated = map["simulated"];
    const YamlValue candump = map["candump"];
    const YamlValue socketcan = map["socketcan"];
    map.Finish();
    if (simulated.given() + candump.given() + socketcan.given() != 1)
        value.Refuse("a map with either simulated, candump or socketcan");
    ReadTrue(simulated);
    ReadPath(candump, context, can.candump);
    ReadInterface(socketcan, can.interface);
    if (candump.given()) can.source = CanConfig::Source::kCandump;
    if (socketcan.given()) can.source = CanConfig::Source::kSocketCan;
}

std::vector<std::string> NamesOf(const auto& named) {
    std::vector<std::string> names;
    for (const auto& one : named) names.push_back(one.name);
    return names;
}

/// The one of `named` that `value` names; null, with a complaint, where there is none.
const auto* ReadName(const YamlValue& value, const auto& named, const std::string& of) {
    std::string name;
    value.Read(name);
    const auto found = std::ranges::find(named, name, [](const auto& one) { return one.name; });
    if (found != named.end()) return &*found;
    if (!name.empty()) value.Refuse(of + MostLike(name, NamesOf(named)));
    return static_cast<decltype(&*found)>(nullptr);
}

/// The file, and the message and the signal in it.
DbcNames ReadNames(YamlMap& map, const YamlValue& dbc, const ConfigContext& context) {
    DbcNames names;
    const YamlValue message = map.Required("message");
    const YamlValue signal = map.Required("signal");
    std::filesystem::path file;
    ReadPath(dbc, context, file);
    if (file.empty()) return names;
    names.file = file.filename().string();
    auto loaded = LoadDbc(file);
    if (!loaded) {
        dbc.Refuse("a DBC file that can be read: " + loaded.error());
        return names;
    }
    names.dbc = std::move(*loaded);
    names.message = ReadName(message, names.dbc.messages, "a message of " + names.file);
    if (names.message != nullptr) {
        names.signal =
            ReadName(signal, names.message->signals, "a signal of message " + names.message->name);
    }
    return names;
}

/// Degrees, to the left, in one unit of the signal.
double ReadUnit(YamlMap& map, const YamlValue& named, const DbcSignal* signal) {
    const YamlValue unit = map["unit"];
    const char* given = "";
    unit.Read(kUnits, given);
    double side = 1;
    map["positive"].Read(kSides, side);
    const std::string text = unit.given() || signal == nullptr ? given : signal->unit;
    const auto degrees = DegreesIn(text);
    if (!degrees && !unit.given() && signal != nullptr) {
        named.Refuse("a signal in degrees or radians, or unit must be given; that of line " +
                     std::to_string(signal->line) + " is in '" + signal->unit + "'");
    }
    return side * degrees.value_or(1);
}

/// A value of the quality signal, by its text or its number.
void ReadQuality(const YamlValue& value, const DbcSignal& signal, std::vector<std::int64_t>& raws) {
    std::string quality;
    value.Read(quality);
    std::vector<std::string> texts;
    for (const DbcValueText& text : signal.texts) {
        texts.push_back(text.text);
        if (text.text == quality) return raws.push_back(text.raw);
    }
    if (!quality.empty() && quality.find_first_not_of("0123456789") == quality.npos) {
        std::int64_t raw = 0;
        value.Read(Range<std::int64_t>{0, UINT32_MAX}, raw);
        raws.push_back(raw);
    } else {
        value.Refuse("a value of signal " + signal.name + ", its number or its text" +
                     MostLike(quality, texts));
    }
}

void ReadStatus(YamlMap& map, const DbcNames& names, HitchAngleSignal& angle) {
    const YamlValue quality = map["quality_signal"];
    const YamlValue valid =
        quality.given() ? map.Required("valid_qualities") : map["valid_qualities"];
    if (!quality.given()) valid.Refuse("absent without quality_signal");
    const auto values = valid.List({1, kMaxQualities});
    if (!quality.given() || names.message == nullptr) return;
    const DbcSignal* const signal =
        ReadName(quality, names.message->signals, "a signal of message " + names.message->name);
    if (signal == nullptr) return;
    const auto field = FieldOf(*names.message, *signal);
    if (!field) return quality.Refuse(field.error());
    if (signal->multiplexed_by && names.signal != nullptr &&
        signal->multiplexed_by != names.signal->multiplexed_by) {
        quality.Refuse("in the same frames as the angle: multiplexed alike or not at all");
    }
    angle.status = HitchAngleStatus{.field = field.value()};
    for (const YamlValue& value : values) ReadQuality(value, *signal, angle.status->valid);
    angle.status->errors = CodesOf(*signal).errors;
    // What the rig file calls valid is valid, whatever its text sounds like.
    std::erase_if(angle.status->errors, [&](std::int64_t raw) {
        return std::ranges::find(angle.status->valid, raw) != angle.status->valid.end();
    });
}

HitchAngleSignal ReadDbcSignal(YamlMap& map, const YamlValue& dbc, const ConfigContext& context) {
    for (const char* key :
         {"id", "start_bit", "length_bits", "byte_order", "signed", "factor_deg", "offset_deg"}) {
        map[key].Refuse("absent with dbc");
    }
    const DbcNames names = ReadNames(map, dbc, context);
    const YamlValue signal = map["signal"];
    const double unit_deg = ReadUnit(map, signal, names.signal);
    HitchAngleSignal angle;
    if (names.signal != nullptr) {
        auto found = HitchAngleOf(*names.message, *names.signal, unit_deg);
        if (found) {
            angle = std::move(*found);
        } else {
            signal.Refuse(found.error());
        }
    }
    ReadStatus(map, names, angle);
    return angle;
}

HitchAngleSignal ReadBits(YamlMap& map) {
    for (const char* key :
         {"message", "signal", "unit", "positive", "quality_signal", "valid_qualities"}) {
        map[key].Refuse("absent without dbc");
    }
    HitchAngleSignal signal;
    map.Required("id").Read(Range<std::uint32_t>{0, 0x1FFFFFFF}, signal.id);
    map.Required("start_bit").Read(Range<int>{0, 511}, signal.start_bit);
    map.Required("length_bits").Read(Range<int>{1, 32}, signal.length_bits);
    map["byte_order"].Read(kByteOrders, signal.byte_order);
    map["signed"].Read(signal.is_signed);
    const YamlValue factor = map.Required("factor_deg");
    factor.Read({-1000, 1000}, signal.factor_deg);
    if (signal.factor_deg == 0) factor.Refuse("other than 0");
    map["offset_deg"].Read({-100000, 100000}, signal.offset_deg);
    return signal;
}

void ReadPlausibility(YamlMap& map, HitchAngleSignal& signal) {
    map["min_deg"].Read({-360, 360}, signal.min_deg);
    const YamlValue max_deg = map["max_deg"];
    max_deg.Read({-360, 360}, signal.max_deg);
    if (signal.max_deg <= signal.min_deg) max_deg.Refuse("greater than min_deg");
    map["max_rate_deg_s"].Read({0, 10000}, signal.max_rate_deg_s);
    map["j1939"].Read(signal.j1939);
    int max_age_ms = static_cast<int>(signal.max_age.count());
    map["max_age_ms"].Read(Range<int>{0, 60000}, max_age_ms);
    signal.max_age = std::chrono::milliseconds(max_age_ms);
}

HitchAngleSignal ReadHitchAngle(const YamlValue& value, const ConfigContext& context) {
    YamlMap map = value.Map();
    const YamlValue dbc = map["dbc"];
    HitchAngleSignal signal = dbc.given() ? ReadDbcSignal(map, dbc, context) : ReadBits(map);
    ReadPlausibility(map, signal);
    map.Finish();
    return signal;
}

/// Of a recording, which carries no DBC file.
bool LacksDbc(const YamlValue& can, const ConfigContext& context) {
    YamlMap map = can.Map();
    YamlMap hitch_angle = map["hitch_angle"].Map();
    std::filesystem::path dbc;
    ReadPath(hitch_angle["dbc"], context, dbc);
    std::error_code failed;
    return !dbc.empty() && !std::filesystem::exists(dbc, failed);
}

}  // namespace

std::optional<CanConfig> ReadCan(const YamlValue& value, const ConfigContext& context) {
    if (!value.given()) return std::nullopt;
    if (context.recorded && LacksDbc(value, context)) {
        std::fprintf(stderr, "the DBC file of the rig is not here: no hitch angle is decoded\n");
        return std::nullopt;
    }
    CanConfig can;
    YamlMap map = value.Map();
    ReadCanSource(map.Required("source"), context, can);
    const YamlValue buffer = map["receive_buffer_bytes"];
    buffer.Read(Range<int>{4096, 1 << 26}, can.receive_buffer_bytes);
    if (can.source != CanConfig::Source::kSocketCan)
        buffer.Refuse("absent unless source is {socketcan: INTERFACE}");
    can.hitch_angle = ReadHitchAngle(map.Required("hitch_angle"), context);
    map.Finish();
    return can;
}

}  // namespace hitchview::app
