#include "calib/session_board.hpp"

#include <algorithm>
#include <string>

namespace hitchview::calib {
namespace {

/// Whether a picture that shows one could as well show the other.
bool LookAlike(const Board& a, const Board& b) {
    const bool tags = a.pattern != Pattern::kCheckerboard && b.pattern != Pattern::kCheckerboard;
    if (tags) return a.first_tag < b.first_tag + b.tags() && b.first_tag < a.first_tag + a.tags();
    return a.pattern == b.pattern &&
           std::minmax(a.columns, a.rows) == std::minmax(b.columns, b.rows);
}

}  // namespace

std::optional<Board> ReadSessionBoard(const YamlValue& value,
                                      [[maybe_unused]] const std::filesystem::path& folder,
                                      std::span<const UnitTarget> others) {
    std::string text;
    value.Read(text);
    if (text.empty()) return std::nullopt;
    const ParsedBoard parsed = ParseBoard(text);
    if (!parsed.board) {
        value.Refuse("a board: " + parsed.error);
        return std::nullopt;
    }
    for (const UnitTarget& other : others) {
        if (!LookAlike(other.board, *parsed.board)) continue;
        value.Refuse("one that cannot be mistaken for that of " + other.name +
                     ": other tags, or another number of squares");
        return std::nullopt;
    }
    return parsed.board;
}

}  // namespace hitchview::calib
