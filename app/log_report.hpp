#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/log_verdict.hpp"

namespace hitchview::app {

/// What cannot be known is null.
nlohmann::json LogReport(const LogFigures& figures, const LogVerdict& verdict);

/// The same for a person.
std::string LogTable(const LogFigures& figures, const LogVerdict& verdict);

}  // namespace hitchview::app
