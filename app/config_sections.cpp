#include "app/config_sections.hpp"

#include <array>

namespace hitchview::app {
namespace {

using calib::Choice;
using calib::Range;
using calib::YamlMap;
using calib::YamlValue;

constexpr std::array kProfiles{
    Choice<SimulationConfig::Profile>{"straight", SimulationConfig::Profile::kStraight},
    Choice<SimulationConfig::Profile>{"slalom", SimulationConfig::Profile::kSlalom},
    Choice<SimulationConfig::Profile>{"turn_left", SimulationConfig::Profile::kTurnLeft},
    Choice<SimulationConfig::Profile>{"turn_right", SimulationConfig::Profile::kTurnRight}};
constexpr std::array kBorders{
    Choice<StabilizationConfig::Border>{"free", StabilizationConfig::Border::kFree},
    Choice<StabilizationConfig::Border>{"covered", StabilizationConfig::Border::kCovered}};
constexpr std::array kSmoothers{
    Choice<StabilizationConfig::Smoother>{"receding_horizon",
                                          StabilizationConfig::Smoother::kRecedingHorizon},
    Choice<StabilizationConfig::Smoother>{"paper_weights",
                                          StabilizationConfig::Smoother::kPaperWeights}};
using LockMemory = RealTimeConfig::LockMemory;
constexpr std::array kLockMemory{Choice<LockMemory>{"false", LockMemory::kNever},
                                 Choice<LockMemory>{"try", LockMemory::kTry},
                                 Choice<LockMemory>{"required", LockMemory::kRequired}};

/// `allowed`: a range or choices.
template <typename Allowed, typename T>
void ReadOptional(const YamlValue& value, const Allowed& allowed, std::optional<T>& out) {
    if (!value.given()) return;
    T read{};
    value.Read(allowed, read);
    out = read;
}

std::optional<Size> ReadCameraSize(const YamlValue& value) {
    if (!value.given()) return std::nullopt;
    Size size;
    ReadSize(value, {64, 4096, true}, {64, 4096, true}, size);
    if (size.height_px > size.width_px) value.Refuse("at least as wide as high");
    return size;
}

/// How long the drive is: once, forth and back, or without an end.
void ReadLength(YamlMap& map, ConfigContext& context, SimulationConfig& simulation) {
    const YamlValue frames = map["frames"];
    const YamlValue loop = map["loop_frames"];
    const YamlValue live = map["live"];
    constexpr int kMostFrames = 36'000;           // 20 minutes
    constexpr int kMostLoopedFrames = 36'000'000;  // that are shown again
    ReadOptional(frames, Range<int>{1, loop.given() ? kMostLoopedFrames : kMostFrames},
                 simulation.frames);
    ReadOptional(loop, Range<int>{2, 600}, simulation.loop_frames);
    live.Read(simulation.live);
    if (!simulation.live) return;
    context.live_simulation = true;
    if (!loop.given()) live.Refuse("absent or false without loop_frames");
    if (context.recorded_cameras > context.simulated_cameras)
        live.Refuse("absent or false beside cameras that are not simulated");
    frames.Refuse("absent with live: true, which goes on until it is stopped");
}

}  // namespace

void ReadPath(const YamlValue& value, const ConfigContext& context, std::filesystem::path& out) {
    std::string text;
    value.Read(text);
    if (!text.empty()) out = (context.folder / text).lexically_normal();
}

void ReadSize(const YamlValue& value, const Range<int>& width, const Range<int>& height,
              Size& out) {
    const auto items = value.List({2, 2});
    if (items.empty()) return;
    items[0].Read(width, out.width_px);
    items[1].Read(height, out.height_px);
}

void ReadTrue(const YamlValue& value) {
    bool is_true = true;
    value.Read(is_true);
    if (!is_true) value.Refuse("true");
}

SimulationConfig ReadSimulation(const YamlValue& value, ConfigContext& context) {
    SimulationConfig simulation;
    if (value.given() && context.simulated_cameras == 0) {
        value.Refuse("absent unless a camera has the source {simulated: true}");
    }
    YamlMap map = value.Map();
    map["scenario"].Read(simulation.scenario);
    ReadOptional(map["seed"], Range<std::uint32_t>{0, UINT32_MAX}, simulation.seed);
    ReadLength(map, context, simulation);
    ReadOptional(map["profile"], kProfiles, simulation.profile);
    simulation.camera_size_px = ReadCameraSize(map["camera_size_px"]);
    ReadOptional(map["speed_mps"], Range<double>{0, 30}, simulation.speed_mps);
    YamlMap shake = map["shake"].Map();
    for (const algo::Unit unit : algo::kUnits) {
        ReadOptional(shake[algo::ToString(unit)], Range<double>{0, 5}, simulation.shake[unit]);
    }
    shake.Finish();
    ReadOptional(map["noise"], Range<double>{0, 50}, simulation.noise);
    map.Finish();
    return simulation;
}

StabilizationConfig ReadStabilization(const YamlValue& value) {
    StabilizationConfig stabilization;
    YamlMap map = value.Map();
    map["enabled"].Read(stabilization.enabled);
    map["lookahead_frames"].Read(Range<int>{0, kMaxLookaheadFrames},
                                 stabilization.lookahead_frames);
    map["border"].Read(kBorders, stabilization.border);
    map["cropping"].Read({0.5, 1}, stabilization.cropping);
    map["smoother"].Read(kSmoothers, stabilization.smoother);
    map.Finish();
    return stabilization;
}

StitchingConfig ReadStitching(const YamlValue& value) {
    StitchingConfig stitching;
    YamlMap map = value.Map();
    map["enabled"].Read(stitching.enabled);
    map["kappa"].Read({0, 1}, stitching.kappa);
    map.Finish();
    return stitching;
}

void ReadThreads(const YamlValue& value, RigConfig& config) {
    ThreadSchedule& schedule = config.schedule;
    YamlMap map = value.Map();
    map["workers"].Read(Range<int>{1, kMaxWorkers}, config.workers);
    map["priority"].Read(Range<int>{0, 99}, schedule.priority);
    for (const YamlValue& cpu : map["affinity"].List({1, kMaxCpus}))
        cpu.Read(Range<int>{0, kMaxCpus - 1}, schedule.affinity.emplace_back());
    map.Finish();
}

RealTimeConfig ReadRealTime(const YamlValue& value) {
    RealTimeConfig real_time;
    YamlMap map = value.Map();
    map["lock_memory"].Read(kLockMemory, real_time.lock_memory);
    map.Finish();
    return real_time;
}

}  // namespace hitchview::app
