#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hitchview::app {

/// One lens, of the figures of `intrinsics`, as HTML without its verdict.
std::string LensReport(const nlohmann::json& lens);

/// Its figures that count most, in one line of text.
std::string LensSummary(const nlohmann::json& lens);

}  // namespace hitchview::app
