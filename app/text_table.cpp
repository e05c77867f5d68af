#include "app/text_table.hpp"

#include <algorithm>
#include <sstream>

namespace hitchview::app {
namespace {

constexpr std::size_t kLineLength = 100;
constexpr std::size_t kLabelEnd = 10;
constexpr const char* kIndent = "  ";
constexpr const char* kGap = "  ";

std::string Padded(std::string text, std::size_t length) {
    text.resize(std::max(text.size(), length), ' ');
    return text;
}

}  // namespace

std::string Printable(const std::string& text) {
    std::string shown = text;
    std::ranges::replace_if(
        shown, [](char c) { return c < ' ' || c > '~'; }, '?');
    return shown;
}

std::string DetailLines(const std::string& label, const std::string& text) {
    std::string lines;
    std::string line = Padded(kIndent + label, kLabelEnd);
    std::size_t words_on_line = 0;
    std::istringstream words(text);
    for (std::string word; words >> word; ++words_on_line) {
        if (words_on_line > 0 && line.size() + 1 + word.size() > kLineLength) {
            lines += line + '\n';
            line = Padded("", kLabelEnd);
            words_on_line = 0;
        }
        if (words_on_line > 0) line += ' ';
        line += Printable(word);
    }
    return lines + line + '\n';
}

TextTable::TextTable(const std::vector<std::string>& header) {
    Add(header, "");
}

void TextTable::Add(const std::vector<std::string>& cells, const std::string& details) {
    Row row{{}, details};
    for (const std::string& cell : cells) row.cells.push_back(Printable(cell));
    rows_.push_back(row);
}

std::string TextTable::Text() const {
    std::vector<std::size_t> widths(rows_.front().cells.size());
    for (const Row& row : rows_) {
        for (std::size_t i = 0; i < widths.size(); ++i)
            widths[i] = std::max(widths[i], row.cells[i].size());
    }
    std::string text;
    for (const Row& row : rows_) {
        std::string line;
        for (std::size_t i = 0; i < widths.size(); ++i)
            line += Padded(row.cells[i], widths[i]) + kGap;
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n' + row.details;
    }
    return text;
}

}  // namespace hitchview::app
