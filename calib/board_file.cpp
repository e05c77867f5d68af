#include <array>
#include <cmath>
#include <cstdio>

#include "calib/board.hpp"
#include "calib/replace_file.hpp"
#include "calib/tag_family.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {
namespace {

constexpr std::array<Choice<Pattern>, 3> kPatterns{{{"checkerboard", Pattern::kCheckerboard},
                                                    {"charuco", Pattern::kCharuco},
                                                    {"tags", Pattern::kTags}}};

Range<int> Count(Pattern pattern) {
    return pattern == Pattern::kTags ? Range<int>{1, 20} : Range<int>{3, 50};
}

/// The smallest tag that leaves its bits apart, and the largest that leaves white around it.
Range<double> TagSide(double square_m) {
    return {0.3 * square_m, 0.9 * square_m};
}

void ReadTags(YamlMap& root, Board& board) {
    root.Required("tag_m").Read(TagSide(board.square_m), board.tag_m);
    root["first_tag"].Read(Range<int>{0, std::max(0, kTags - board.tags())}, board.first_tag);
}

void ReadKeys(YamlMap& root, Board& board) {
    int schema = 1;
    root.Required("schema").Read(Range<int>{1, 1}, schema);
    root.Required("pattern").Read(kPatterns, board.pattern);
    root.Required("columns").Read(Count(board.pattern), board.columns);
    root.Required("rows").Read(Count(board.pattern), board.rows);
    root.Required("square_m").Read(Range<double>{0.001, 2}, board.square_m);
    if (board.pattern != Pattern::kCheckerboard) ReadTags(root, board);
    root.Finish();
}

ParsedBoard ReadWhole(YamlMap root, const YamlComplaints& complaints) {
    Board board;
    ReadKeys(root, board);
    if (complaints.empty()) return {.board = board};
    return {.error = complaints.Text()};
}

std::string Text(const Board& board) {
    std::string text = "schema: 1\npattern: " + std::string(ToString(board.pattern)) +
                       "\ncolumns: " + std::to_string(board.columns) +
                       "\nrows: " + std::to_string(board.rows) +
                       "\nsquare_m: " + ExactText(board.square_m) + "\n";
    if (board.tags() > 0)
        text += "tag_m: " + ExactText(board.tag_m) +
                "\nfirst_tag: " + std::to_string(board.first_tag) + "\n";
    return text;
}

/// As short as the length in tenths of a millimetre can be said.
std::string Millimetres(double length_m) {
    char text[32];
    std::snprintf(text, sizeof text, "%.10g mm", std::round(1e4 * length_m) / 10);
    return text;
}

bool NamesAFile(const std::string& text) {
    return text.ends_with(".yaml") || text.ends_with(".yml") || text.find('/') != text.npos;
}

}  // namespace

std::string_view ToString(Pattern pattern) {
    return kPatterns[static_cast<std::size_t>(pattern)].name;
}

ParsedBoard LoadBoard(const std::filesystem::path& file) {
    YamlComplaints complaints(file.string());
    return ReadWhole(LoadYaml(file, complaints), complaints);
}

ParsedBoard ParseBoardFile(const std::string& text, const std::string& name) {
    YamlComplaints complaints(name);
    return ReadWhole(ParseYaml(text, complaints), complaints);
}

std::string SaveBoard(const Board& board, const std::filesystem::path& file) {
    return ReplaceFile(file, Text(board),
                       [](const std::filesystem::path& fresh) { return LoadBoard(fresh).error; });
}

ParsedBoard ReadBoard(const std::string& text) {
    std::error_code error;
    if (NamesAFile(text) || std::filesystem::is_regular_file(text, error)) return LoadBoard(text);
    ParsedBoard parsed = ParseBoard(text);
    if (!parsed.board) parsed.error += ", or a board file";
    return parsed;
}

std::string Describe(const Board& board) {
    const bool grid = board.pattern == Pattern::kTags;
    std::string text = std::string(ToString(board.pattern)) + ", " + std::to_string(board.columns) +
                       "x" + std::to_string(board.rows) + (grid ? " tags" : " inner corners");
    text += (grid ? ", from tag to tag " : ", squares of ") + Millimetres(board.square_m);
    if (board.tags() > 0)
        text += ", tags of " + Millimetres(board.tag_m) + " from number " +
                std::to_string(board.first_tag);
    return text;
}

}  // namespace hitchview::calib
