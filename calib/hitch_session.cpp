#include "calib/hitch_session.hpp"

#include "calib/session_board.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {
namespace {

constexpr std::size_t kMostShots = 1000;

RigCalibration ReadRig(const YamlValue& value, const std::filesystem::path& folder) {
    std::string name;
    value.Read(name);
    if (name.empty()) return {};
    LoadedCalibration loaded = LoadCalibration(folder / name);
    if (!loaded.calibration) {
        value.Refuse("a rig calibration: " + loaded.error);
        return {};
    }
    if (loaded.calibration->verdict == Verdict::kFail)
        value.Refuse("a rig calibration whose verdict is not fail");
    return std::move(*loaded.calibration);
}

void ReadPictures(const YamlValue& value, const std::filesystem::path& folder,
                  HitchSession& session) {
    YamlMap map = value.Map();
    algo::PerUnit<bool> has_camera{};
    for (const std::string& name : map.keys()) {
        const YamlValue pattern = map.Required(name);
        std::string text;
        pattern.Read(text);
        const auto camera = session.rig.cameras.find(name);
        if (camera == session.rig.cameras.end()) {
            pattern.Refuse("of a camera of the calibration");
            continue;
        }
        has_camera[camera->second.unit] = true;
        session.problem.names.push_back(name);
        session.problem.cameras.push_back(camera->second);
        session.pictures.push_back((folder / text).string());
    }
    for (const algo::Unit unit : algo::kUnits) {
        if (!has_camera[unit] && !session.rig.cameras.empty())
            value.Refuse(std::string("a map with at least one camera of the ") + ToString(unit));
    }
}

void ReadTargets(const YamlValue& value, const std::filesystem::path& folder,
                 HitchProblem& problem) {
    YamlMap map = value.Map();
    for (const std::string& name : map.keys()) {
        YamlMap target = map.Required(name).Map();
        const auto board = ReadSessionBoard(target.Required("board"), folder, problem.targets);
        target.Finish();
        problem.targets.push_back({.name = name, .board = board.value_or(Board{})});
    }
    if (value.given() && map.keys().empty()) value.Refuse("a map of at least one by name");
}

void ReadStraight(const YamlValue& value, HitchProblem& problem) {
    if (!value.given()) return;
    for (const YamlValue& shot : value.List({1, kMostShots}))
        shot.Read(problem.straight.emplace_back());
}

}  // namespace

LoadedHitchSession LoadHitchSession(const std::filesystem::path& file) {
    YamlComplaints complaints(file.string());
    YamlMap root = LoadYaml(file, complaints);
    const std::filesystem::path folder = file.parent_path();
    HitchSession session;
    int schema = 1;
    root.Required("schema").Read(Range<int>{1, 1}, schema);
    session.rig = ReadRig(root.Required("calibration"), folder);
    ReadPictures(root.Required("pictures"), folder, session);
    ReadTargets(root.Required("targets"), folder, session.problem);
    ReadStraight(root["straight"], session.problem);
    const YamlValue height = root["height_m"];
    if (height.given()) height.Read(Range<double>{-5, 5}, session.problem.height_m);
    root.Finish();
    if (!complaints.empty()) return {std::nullopt, complaints.Text()};
    return {std::move(session), ""};
}

}  // namespace hitchview::calib
