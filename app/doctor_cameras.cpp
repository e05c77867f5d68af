#include <unistd.h>

#include <algorithm>
#include <future>
#include <thread>

#include "app/camera_match.hpp"
#include "app/doctor.hpp"

namespace hitchview::app {
namespace {

constexpr std::chrono::milliseconds kPatience{1800};

bool HasDevices(const DoctorSubject& subject) {
    return !WishesOf(subject.rig.config).empty();
}

/// What the devices say, asked once for all checks, from the beginning on. A driver that hangs is
/// left behind.
class ProbedCameras {
 public:
    explicit ProbedCameras(const DoctorCase& subject) {
        if (!HasDevices(*subject)) return;
        std::promise<std::vector<CameraDevice>> promise;
        answer_ = promise.get_future().share();
        std::thread([subject, promise = std::move(promise)]() mutable {
            promise.set_value(subject->machine.cameras(WishesOf(subject->rig.config)));
        }).detach();
    }

    /// Null: there is no answer within `wait`. Only of a rig that has devices.
    [[nodiscard]] const std::vector<CameraDevice>* Devices(std::chrono::milliseconds wait) const {
        return answer_.wait_for(wait) == std::future_status::ready ? &answer_.get() : nullptr;
    }

 private:
    std::shared_future<std::vector<CameraDevice>> answer_{};
};

/// What there is to say of some cameras.
class CameraList {
 public:
    void Add(const std::string& camera, const std::string& what) {
        if (!text_.empty()) text_ += "; ";
        text_ += camera + ": " + what;
    }
    [[nodiscard]] bool empty() const { return text_.empty(); }
    [[nodiscard]] const std::string& text() const { return text_; }

 private:
    std::string text_{};
};

Diagnosis NoDevices() {
    return {.what = "no camera of the rig is a V4L2 device"};
}

const CameraDevice* Find(const std::vector<CameraDevice>& devices, const std::string& path) {
    const auto found = std::ranges::find(devices, path, &CameraDevice::path);
    return found == devices.end() ? nullptr : &*found;
}

/// The rig's cameras with each path where it stands on that machine.
RigConfig Placed(const DoctorSubject& subject) {
    RigConfig rig = subject.rig.config;
    for (const algo::Unit unit : algo::kUnits) {
        for (CameraConfig& camera : rig.units[unit].cameras) {
            if (camera.source == CameraConfig::Source::kV4l2)
                camera.live.device = subject.machine.At(camera.live.device);
        }
    }
    return rig;
}

std::vector<CameraMatch> Matches(const DoctorSubject& subject,
                                 const std::vector<CameraDevice>& devices) {
    auto matches = MatchCameras(Placed(subject), devices);
    std::erase_if(matches, [](const CameraMatch& match) { return !match.looked_for; });
    return matches;
}

std::string Count(std::size_t cameras) {
    return std::to_string(cameras) + (cameras == 1 ? " camera" : " cameras");
}

/// A camera of the rig that leads to no device, or to one that another has.
bool IsMissing(const std::vector<CameraMatch>& matches, const CameraMatch& match) {
    if (match.device.empty()) return true;
    const auto first = std::ranges::find(matches, match.device, &CameraMatch::device);
    return &*first != &match;
}

Diagnosis CheckDevices(const DoctorSubject& subject, const ProbedCameras& probed) {
    if (!HasDevices(subject)) return NoDevices();
    const auto* const devices = probed.Devices(kPatience);
    if (devices == nullptr) {
        return {Finding::kBad, "the video devices give no answer",
                "see what the kernel says of them: dmesg"};
    }
    const auto matches = Matches(subject, *devices);
    CameraList missing;
    for (const CameraMatch& match : matches) {
        if (IsMissing(matches, match))
            missing.Add(match.name, match.configured + ": " + match.problem);
    }
    if (missing.empty()) return {Finding::kGood, Count(matches.size()) + ", each its own device"};
    return {Finding::kBad, missing.text(),
            "look at cable and power of the camera; /etc/hitchview/cameras says which place has "
            "which name, hitchview cameras what is there"};
}

std::string AccessRemedy(const DoctorSubject& subject) {
    return "udevadm trigger --action=add --subsystem-match=video4linux (group video, mode 0660); "
           "usermod --append --groups video " +
           (subject.user().empty() ? "USER" : subject.user()) +
           "; then systemctl restart hitchview";
}

Diagnosis CheckAccess(const DoctorSubject& subject, const ProbedCameras& probed) {
    if (!HasDevices(subject)) return NoDevices();
    const auto* const devices = probed.Devices({});
    if (devices == nullptr) return {.what = "after camera_devices"};
    const auto ids = subject.user_ids();
    if (!ids) return {.what = "there is no user " + subject.user()};
    CameraList refused;
    std::size_t asked = 0;
    for (const CameraMatch& match : Matches(subject, *devices)) {
        if (match.device.empty()) continue;
        ++asked;
        if (!MayAccess(*ids, subject.machine.root, match.device, R_OK | W_OK))
            refused.Add(match.name, match.device);
    }
    if (asked == 0) return {.what = "after camera_devices"};
    const std::string who = subject.who();
    if (refused.empty()) return {Finding::kGood, who + " may open " + Count(asked)};
    return {Finding::kBad, who + " may not open " + refused.text(), AccessRemedy(subject)};
}

Diagnosis CheckFormats(const DoctorSubject& subject, const ProbedCameras& probed) {
    if (!HasDevices(subject)) return NoDevices();
    const auto* const devices = probed.Devices({});
    if (devices == nullptr) return {.what = "after camera_devices"};
    const auto matches = Matches(subject, *devices);
    CameraList wrong;
    CameraList closed;
    std::size_t asked = 0;
    for (const CameraMatch& match : matches) {
        const CameraDevice* const device = Find(*devices, match.device);
        if (device == nullptr || IsMissing(matches, match)) continue;
        ++asked;
        if (device->state == CameraDevice::State::kForbidden) {
            closed.Add(match.name, device->refusal);
        } else if (!match.problem.empty()) {
            wrong.Add(match.name, match.problem);
        }
    }
    if (!wrong.empty()) {
        return {Finding::kBad, wrong.text(),
                "hitchview cameras --all lists what each offers; put size_px, format, period_ms, "
                "input or controls in the rig file right"};
    }
    if (asked == 0) return {.what = "after camera_devices"};
    if (!closed.empty())
        return {.what = "this user may not ask them (sudo does): " + closed.text()};
    return {Finding::kGood, Count(asked) + " can give what the rig asks of them"};
}

}  // namespace

std::vector<DoctorCheck> CameraChecks(const DoctorCase& subject) {
    const auto probed = std::make_shared<const ProbedCameras>(subject);
    return {{"camera_devices", [=] { return CheckDevices(*subject, *probed); }},
            {"camera_access", [=] { return CheckAccess(*subject, *probed); }},
            {"camera_formats", [=] { return CheckFormats(*subject, *probed); }}};
}

}  // namespace hitchview::app
