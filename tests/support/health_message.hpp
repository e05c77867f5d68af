#pragma once

#include <string>
#include <vector>

#include "drivers/lcm_encoder.hpp"
#include "hal/fake_clock.hpp"

namespace hitchview::tests {

/// A sound hitchview.health_t with cameras of these names and two stages.
inline std::vector<std::uint8_t> HealthMessage(const std::vector<std::string>& cameras) {
    const hal::FakeClock clock;
    const auto encoder = drivers::LcmEncoder::Create({}, clock);
    hal::Health health{.version = std::string_view("1.2.3"), .warning = std::string_view("none")};
    for (const std::string& name : cameras) {
        health.cameras.Add(
            {.name = std::string_view(name), .unit = std::string_view("tractor"), .shown = true});
    }
    health.stages.Add({.name = std::string_view("total")});
    health.stages.Add({.name = std::string_view("jpeg")});
    const auto message = encoder.value()->Encode(health);
    return {message.value().bytes.begin(), message.value().bytes.end()};
}

}  // namespace hitchview::tests
