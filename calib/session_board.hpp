#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "calib/unit_problem.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {

/// A target's board in a session: `COLSxROWS,SQUARE_M`, or the name of a board file in `folder`.
/// Complains about one that cannot be read, or that could be mistaken for that of one of `others`
/// in a picture; empty then.
std::optional<Board> ReadSessionBoard(const YamlValue& value, const std::filesystem::path& folder,
                                      std::span<const UnitTarget> others);

}  // namespace hitchview::calib
