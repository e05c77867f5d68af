#pragma once

#include <string>
#include <vector>

namespace hitchview::app {

/// A text as a terminal shows it as one character a byte: what is not printable ASCII, as '?'.
std::string Printable(const std::string& text);

/// `label` and `text` under a row, wrapped between words to 100 characters; a word that is longer
/// stands on a line of its own. Ends with a new line.
std::string DetailLines(const std::string& label, const std::string& text);

/// Rows of cells in columns as wide as they need to be, each row with lines of its own under it.
class TextTable {
 public:
    explicit TextTable(const std::vector<std::string>& header);

    /// As many cells as the header has. `details`: from DetailLines.
    void Add(const std::vector<std::string>& cells, const std::string& details);
    [[nodiscard]] std::string Text() const;

 private:
    struct Row {
        std::vector<std::string> cells;
        std::string details;
    };

    std::vector<Row> rows_;
};

}  // namespace hitchview::app
