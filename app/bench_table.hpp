#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hitchview::app {

/// The figures of BenchVerb for a person.
std::string BenchTable(const nlohmann::json& figures);

}  // namespace hitchview::app
