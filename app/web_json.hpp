#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/web_cameras.hpp"
#include "drivers/lcm_log_messages.hpp"
#include "drivers/lcm_logged_health.hpp"
#include "drivers/lcm_logged_overlay.hpp"

namespace hitchview::app {

// What the page is told, as JSON. Times in ms, angles in degrees; what is not a number is null.

nlohmann::json CameraJson(const WebCamera& camera);
nlohmann::json StatusJson(const hal::PanoramaStatus& status);
nlohmann::json HealthJson(const drivers::LoggedHealth& health);
nlohmann::json HitchAngleJson(const hal::HitchAngle& angle);
nlohmann::json OverlayJson(const drivers::LoggedOverlay& overlay);

/// Two decimals: what a chart shows.
double Rounded(double value);
double Milliseconds(hal::Instant duration);
double Degrees(double angle_rad);

/// One line. What is not UTF-8 in texts from the network is replaced.
std::string Line(const nlohmann::json& value);

}  // namespace hitchview::app
