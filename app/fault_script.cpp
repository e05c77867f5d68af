#include "app/fault_script.hpp"

#include <algorithm>

#include "calib/yaml_map.hpp"

namespace hitchview::app {
namespace {

using calib::Choice;
using calib::Range;
using calib::YamlMap;
using calib::YamlValue;

constexpr std::array kKinds{Choice<FaultKind>{"dead", FaultKind::kDead},
                            Choice<FaultKind>{"other_format", FaultKind::kOtherFormat},
                            Choice<FaultKind>{"silent", FaultKind::kSilent},
                            Choice<FaultKind>{"damaged", FaultKind::kDamaged},
                            Choice<FaultKind>{"late", FaultKind::kLate},
                            Choice<FaultKind>{"swapped_stamps", FaultKind::kSwappedStamps},
                            Choice<FaultKind>{"stuck_numbers", FaultKind::kStuckNumbers},
                            Choice<FaultKind>{"frozen", FaultKind::kFrozen},
                            Choice<FaultKind>{"black", FaultKind::kBlack},
                            Choice<FaultKind>{"blinded", FaultKind::kBlinded},
                            Choice<FaultKind>{"blurred", FaultKind::kBlurred},
                            Choice<FaultKind>{"dirty", FaultKind::kDirty}};
static_assert(kKinds.size() == kFaultKinds.size());

/// A day at 100 Hz.
constexpr int kMostFrames = 8'640'000;
constexpr std::size_t kMostFaults = 10'000;

void ReadCameras(const YamlValue& value, std::vector<std::string>& cameras) {
    if (value.is_list()) {
        for (const YamlValue& name : value.List({1, kMaxCameras}))
            name.Read(cameras.emplace_back());
        return;
    }
    std::string name;
    value.Read(name);
    if (name != "all") cameras.push_back(name);
}

ScriptedFault ReadFault(const YamlValue& value) {
    ScriptedFault fault;
    YamlMap map = value.Map();
    ReadCameras(map.Required("camera"), fault.cameras);
    map.Required("does").Read(kKinds, fault.fault.does);
    map["from"].Read(Range<int>{0, kMostFrames}, fault.fault.from);
    const YamlValue until = map["until"];
    until.Read(Range<int>{1, kMostFrames}, fault.fault.until);
    if (fault.fault.until <= fault.fault.from) until.Refuse("greater than from");
    map.Finish();
    return fault;
}

FaultScript ReadScript(YamlMap root) {
    FaultScript script;
    int schema = 1;
    root.Required("schema").Read(Range<int>{1, 1}, schema);
    const YamlValue scenario = root["scenario"];
    if (scenario.given()) scenario.Read(script.scenario.emplace());
    const YamlValue frames = root["frames"];
    if (frames.given()) frames.Read(Range<int>{1, 36'000}, script.frames.emplace(1));
    for (const YamlValue& fault : root.Required("faults").List({0, kMostFaults}))
        script.faults.push_back(ReadFault(fault));
    root.Finish();
    return script;
}

hal::Checked<FaultScript> Checked(FaultScript script, const calib::YamlComplaints& complaints) {
    if (!complaints.empty()) return complaints.Text();
    return script;
}

std::vector<std::string> CameraNames(const RigConfig& rig) {
    std::vector<std::string> names;
    for (const algo::Unit unit : algo::kUnits)
        for (const CameraConfig& camera : rig.units[unit].cameras) names.push_back(camera.name);
    return names;
}

}  // namespace

const char* ToString(FaultKind kind) {
    const auto found = std::ranges::find(kKinds, kind, &Choice<FaultKind>::value);
    return found == kKinds.end() ? "unknown" : found->name.data();
}

std::vector<CameraFault> FaultScript::Of(const std::string& camera) const {
    std::vector<CameraFault> own;
    for (const ScriptedFault& scripted : faults) {
        const auto& names = scripted.cameras;
        if (names.empty() || std::ranges::find(names, camera) != names.end())
            own.push_back(scripted.fault);
    }
    return own;
}

hal::Checked<FaultScript> LoadFaultScript(const std::filesystem::path& file) {
    calib::YamlComplaints complaints(file.string());
    auto script = Checked(ReadScript(calib::LoadYaml(file, complaints)), complaints);
    if (script) script->file = file.string();
    return script;
}

hal::Checked<FaultScript> ParseFaultScript(const NamedText& text) {
    calib::YamlComplaints complaints(text.name);
    auto script = Checked(ReadScript(calib::ParseYaml(text.text, complaints)), complaints);
    if (script) script->file = text.name;
    return script;
}

hal::Checked<hal::Done> CheckCameras(const FaultScript& script, const RigConfig& rig) {
    const std::vector<std::string> known = CameraNames(rig);
    for (std::size_t i = 0; i < script.faults.size(); ++i) {
        for (const std::string& camera : script.faults[i].cameras) {
            if (std::ranges::find(known, camera) != known.end()) continue;
            std::string must_be = script.file + ": faults[" + std::to_string(i) + "].camera is " +
                                  camera + ", must be all or of " + rig.file.string() + ":";
            for (const std::string& name : known) must_be += ' ' + name;
            return must_be;
        }
    }
    return hal::Done{};
}

void TakeDrive(const FaultScript& script, RigConfig& rig) {
    rig.simulation.scenario = script.scenario.value_or(rig.simulation.scenario);
    if (script.frames) rig.simulation.frames = script.frames;
}

}  // namespace hitchview::app
