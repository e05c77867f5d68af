#include <array>

#include "app/config_sections.hpp"

namespace hitchview::app {
namespace {

using calib::Choice;
using calib::Range;
using calib::YamlMap;
using calib::YamlValue;
using Format = RecordConfig::Format;
using Trigger = RecordConfig::Trigger;

constexpr std::array kFormats{Choice<Format>{"jpeg", Format::kJpeg},
                              Choice<Format>{"raw", Format::kRaw}};
constexpr std::array kTriggers{Choice<Trigger>{"signal", Trigger::kSignal},
                               Choice<Trigger>{"camera_lost", Trigger::kCameraLost},
                               Choice<Trigger>{"camera_fault", Trigger::kCameraFault}};
constexpr int kMostMegabytes = 10'000'000;

void ReadWhen(YamlMap& map, RecordConfig& record) {
    map["pre_trigger_s"].Read(Range<int>{0, 600}, record.pre_trigger_s);
    const YamlValue after = map["after_trigger_s"];
    const YamlValue trigger = map["trigger"];
    after.Read(Range<int>{0, 86'400}, record.after_trigger_s);
    trigger.Read(kTriggers, record.trigger);
    if (record.pre_trigger_s > 0) return;
    after.Refuse("absent without pre_trigger_s");
    trigger.Refuse("absent without pre_trigger_s");
}

void ReadFrames(YamlMap& map, RecordConfig& record) {
    map["format"].Read(kFormats, record.format);
    map["quality"].Read(Range<int>{30, 100}, record.quality);
    map["every"].Read(Range<int>{1, 1000}, record.every);
    map["threads"].Read(Range<int>{1, 8}, record.threads);
}

}  // namespace

RecordConfig ReadRecord(const YamlValue& value, const ConfigContext& context) {
    RecordConfig record;
    YamlMap map = value.Map();
    ReadPath(map["folder"], context, record.folder);
    map["segment_s"].Read(Range<int>{1, 3600}, record.segment_s);
    map["quota_mb"].Read(Range<int>{0, kMostMegabytes}, record.quota_mb);
    map["min_free_mb"].Read(Range<int>{0, kMostMegabytes}, record.min_free_mb);
    map["memory_mb"].Read(Range<int>{8, 16'384}, record.memory_mb);
    ReadWhen(map, record);
    ReadFrames(map, record);
    map.Finish();
    return record;
}

}  // namespace hitchview::app
