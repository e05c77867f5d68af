#include "app/web_cameras.hpp"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "app/web_json.hpp"
#include "hal/camera_state.hpp"
#include "lcmtypes/hitchview_event_t.h"

namespace hitchview::app {
namespace {

using hal::Instant;
using std::chrono::milliseconds;

/// Status comes with each panorama, health once a second.
constexpr milliseconds kStatusHolds{1000};
constexpr milliseconds kHealthHolds{2500};
/// By then the status speaks of frames after the event.
constexpr milliseconds kEventSettles{3000};

bool IsRecent(std::optional<Instant> maybe_at, Instant now, milliseconds holds) {
    return maybe_at && now - *maybe_at <= holds;
}

std::string ConditionOf(int state) {
    const bool known = state >= 0 && state < static_cast<int>(hal::kCameraStates.size());
    return known ? hal::ToString(static_cast<hal::CameraState>(state)) : "unknown";
}

/// The state that an event of a camera tells; empty for other events.
std::optional<hal::CameraState> StateToldBy(int code) {
    switch (code) {
        case HITCHVIEW_EVENT_T_CAMERA_LOST:
            return hal::CameraState::kLost;
        case HITCHVIEW_EVENT_T_CAMERA_BACK:
            return hal::CameraState::kGood;
        case HITCHVIEW_EVENT_T_CAMERA_LATE:
            return hal::CameraState::kLate;
        case HITCHVIEW_EVENT_T_CAMERA_DISORDERED:
            return hal::CameraState::kDisordered;
        case HITCHVIEW_EVENT_T_CAMERA_BLACK:
            return hal::CameraState::kBlack;
        case HITCHVIEW_EVENT_T_CAMERA_BLINDED:
            return hal::CameraState::kBlinded;
        case HITCHVIEW_EVENT_T_CAMERA_FROZEN:
            return hal::CameraState::kFrozen;
        case HITCHVIEW_EVENT_T_CAMERA_STUCK:
            return hal::CameraState::kStuck;
        case HITCHVIEW_EVENT_T_CAMERA_BLURRED:
            return hal::CameraState::kBlurred;
        case HITCHVIEW_EVENT_T_CAMERA_DIRTY:
            return hal::CameraState::kDirty;
        default:
            return std::nullopt;
    }
}

/// `began`: a panorama was made, before that none shows a camera.
WebCamera CameraOf(const drivers::LoggedCameraHealth& health, bool began) {
    return {.name = std::string(health.name),
            .unit = std::string(health.unit),
            .frames_per_s = health.frames_per_s,
            .age_ms = health.age_ms,
            .delivered = health.delivered,
            .lost = health.lost,
            .corrupted = health.corrupted,
            .reopened = health.reopened,
            .has_figures = true,
            .condition = ConditionOf(health.state),
            .shown = health.shown || !began};
}

}  // namespace

const char* ToString(WebCameraState state) {
    switch (state) {
        case WebCameraState::kUnknown:
            return "unknown";
        case WebCameraState::kLive:
            return "live";
        case WebCameraState::kLost:
            return "lost";
    }
    return "unknown";
}

WebCameras::WebCameras(std::vector<WebCamera> cameras) : cameras_(std::move(cameras)) {
    cameras_.resize(std::min(cameras_.size(), kMostCameras));
}

void WebCameras::TakeMissing(std::uint32_t cameras_missing, Instant now) {
    const auto told = static_cast<std::size_t>(std::bit_width(cameras_missing));
    while (cameras_.size() < told) {
        cameras_.push_back({.name = "camera " + std::to_string(cameras_.size() + 1)});
    }
    missing_ = cameras_missing;
    status_at_ = now;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        WebCamera& camera = cameras_[i];
        const bool settled = !IsRecent(camera.lost_since, now, kEventSettles);
        if (settled && (missing_ >> i & 1U) == 0) camera.lost_since.reset();
    }
}

void WebCameras::TakeHealth(const drivers::LoggedHealth& health, Instant now) {
    std::vector<WebCamera> cameras;
    for (const auto& told : health.cameras) {
        WebCamera camera = CameraOf(told, health.panoramas > 0);
        const auto known = std::ranges::find(cameras_, camera.name, &WebCamera::name);
        if (known != cameras_.end()) camera.lost_since = known->lost_since;
        cameras.push_back(std::move(camera));
    }
    if (!cameras.empty()) cameras_ = std::move(cameras);
    health_at_ = now;
}

void WebCameras::TakeEvent(const drivers::LoggedEvent& event, Instant now) {
    const auto camera = std::ranges::find(cameras_, event.subject, &WebCamera::name);
    if (camera == cameras_.end()) return;
    const auto state = StateToldBy(event.code);
    if (!state) return;
    camera->condition = hal::ToString(*state);
    if (!hal::IsShown(*state)) {
        camera->lost_since = now;
    } else {
        camera->lost_since.reset();
        camera->shown = true;
    }
}

bool WebCameras::IsLost(std::size_t camera, Instant now) const {
    const bool status = IsRecent(status_at_, now, kStatusHolds);
    const bool missing = status && (missing_ >> camera & 1U) != 0;
    // The status comes with every panorama, health once a second: the newer one counts.
    const bool newest = !status || health_at_ >= status_at_;
    const bool hidden =
        newest && IsRecent(health_at_, now, kHealthHolds) && !cameras_[camera].shown;
    return missing || hidden || cameras_[camera].lost_since;
}

WebCameraState WebCameras::State(std::size_t camera, Instant now) const {
    HV_EXPECT(camera < cameras_.size());
    const bool status = IsRecent(status_at_, now, kStatusHolds);
    const bool health = IsRecent(health_at_, now, kHealthHolds);
    if ((status || health) && IsLost(camera, now)) return WebCameraState::kLost;
    // Health alone says that a camera lives only where no status has ever come.
    return status || (health && !status_at_) ? WebCameraState::kLive : WebCameraState::kUnknown;
}

nlohmann::json WebCameras::ToJson(Instant now) const {
    nlohmann::json list = nlohmann::json::array();
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
        nlohmann::json camera = CameraJson(cameras_[i]);
        camera["state"] = ToString(State(i, now));
        list.push_back(std::move(camera));
    }
    return list;
}

}  // namespace hitchview::app
