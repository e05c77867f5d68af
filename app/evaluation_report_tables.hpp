#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::app {

/// Tables, as HTML, of the figures of `Evaluate`; null is shown as "not measured".

/// The published figures beside these, with a mark where these are as good or better.
std::string PaperTables(const nlohmann::json& figures);

/// The rest: units, seams, panorama.
std::string FigureTables(const nlohmann::json& figures);

/// Which files were measured. `recordings`: as in `Evaluate`.
std::string RecordingsTable(const nlohmann::json& recordings);

/// What each figure means, in a sentence or two.
std::string Definitions();

}  // namespace hitchview::app
