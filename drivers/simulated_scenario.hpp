#pragma once

#include <span>
#include <string>
#include <string_view>

#include "drivers/simulated_options.hpp"

namespace hitchview::drivers {

/// A drive with a name, which puts one thing to the test.
struct Scenario {
    std::string_view name;  ///< letters, digits and _
    std::string_view what;  ///< one sentence
    SimulationOptions options;
};

/// All of them, always the same. About 300 frames of 30 Hz at 1280 x 720; size, frame count and
/// seed may be changed, and what happens still happens at its moment. Thread-safe.
std::span<const Scenario> Scenarios();

/// Null for a name that there is not.
const Scenario* FindScenario(std::string_view name);
/// Every name, with commas between them, for messages.
std::string ScenarioNames();

}  // namespace hitchview::drivers
