#include "app/cameras_verb.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/camera_match.hpp"
#include "app/camera_probe.hpp"
#include "app/camera_table.hpp"
#include "app/exit_code.hpp"
#include "app/report.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

int Show(const CamerasOptions& options, const std::optional<RigConfig>& rig) {
    const auto wishes = rig ? WishesOf(*rig) : std::vector<CameraWish>{};
    const auto devices =
        ProbeCameras(wishes, options.measure ? CameraMeasure::kReadSpeed : CameraMeasure::kNo);
    json everything{{"devices", CamerasJson(devices)}, {"rig", nullptr}};
    std::string text = CameraTable(devices, options.all ? CameraDetail::kAll : CameraDetail::kBest);
    bool all_there = std::ranges::any_of(devices, &CameraDevice::IsOpen);
    if (rig) {
        const auto matches = MatchCameras(*rig, devices);
        everything["rig"] = MatchesJson(matches);
        text += '\n' + MatchTable(matches);
        all_there = AllThere(matches);
    }
    std::fputs(text.c_str(), stdout);
    if (!options.json.empty()) {
        const std::string refused = WriteJson(everything, options.json);
        if (!refused.empty()) return Fail(kMachineFailed, refused);
    }
    return all_there ? kGood : kBad;
}

}  // namespace

int CamerasVerb(const CamerasOptions& options) {
    if (options.rig.empty()) return Show(options, std::nullopt);
    const auto rig = LoadRigConfig(options.rig);
    if (!rig) return Fail(kWrongUse, rig.error());
    if (WishesOf(rig.value()).empty()) {
        return Fail(kWrongUse, options.rig.string() +
                                   ": no camera is a V4L2 device (source: {v4l2: /dev/...}); "
                                   "`cam --list` shows those of libcamera");
    }
    return Show(options, rig.value());
}

}  // namespace hitchview::app
