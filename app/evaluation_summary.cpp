#include "app/evaluation_summary.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/evaluation_paper.hpp"
#include "app/evaluation_statistics.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

// Cropping, distortion, stability, stitching score.
constexpr std::size_t kColumns = kPaperFigures.size() + 1;

struct Row {
    std::string name;
    std::array<std::optional<double>, kColumns> values{};
};

hal::Checked<json> Read(const std::string& path) {
    std::ifstream file(path);
    if (!file) return path + ": cannot be read";
    json figures = json::parse(file, nullptr, false);
    if (!figures.is_object()) return path + ": not a file of `hitchview eval --json`";
    return figures;
}

// Empty for what is null, missing or no number.
std::optional<double> Find(const json& part, const std::string& key) {
    const json::json_pointer pointer("/paper/" + key);
    if (!part.contains(pointer) || !part[pointer].is_number()) return std::nullopt;
    return part[pointer].get<double>();
}

// An empty object where there is none.
json Group(const json& figures, const char* key) {
    return figures.contains(key) ? figures[key] : json::object();
}

void AppendRows(const std::string& path, const json& figures, std::vector<Row>& rows) {
    const json units = Group(figures, "units");
    for (const auto& [unit, part] : units.items()) {
        Row row{.name = path + ' ' + unit};
        for (std::size_t i = 0; i < kPaperFigures.size(); ++i) {
            row.values[i] = Find(part, kPaperFigures[i].key);
        }
        rows.push_back(row);
    }
    const json seams = Group(figures, "seams");
    for (const auto& [seam, part] : seams.items()) {
        const auto maybe_score_px = Find(part, "stitching_score_px");
        if (!maybe_score_px) continue;
        rows.push_back({.name = path + ' ' + seam + " seam"});
        rows.back().values.back() = maybe_score_px;
    }
}

Row MeanOf(const std::vector<Row>& rows) {
    Row mean{.name = "mean"};
    for (std::size_t column = 0; column < kColumns; ++column) {
        std::vector<double> known;
        for (const Row& row : rows) {
            if (row.values[column]) known.push_back(*row.values[column]);
        }
        mean.values[column] = Mean(known);
    }
    return mean;
}

std::string Formatted(const char* format, double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string Padded(const std::string& text, std::size_t width) {
    return std::string(width > text.size() ? width - text.size() : 0, ' ') + text;
}

constexpr std::size_t kCellWidth = 12;

std::string Line(const Row& row, std::size_t name_width) {
    std::string line = row.name + std::string(name_width - row.name.size(), ' ');
    for (const auto& value : row.values) {
        line += Padded(value ? Formatted("%.4f", *value) : "-", kCellWidth);
    }
    return line + '\n';
}

std::string Head(std::size_t name_width) {
    std::string line(name_width, ' ');
    for (const PaperFigure& figure : kPaperFigures) line += Padded(figure.key, kCellWidth);
    return line + Padded("stitching px", kCellWidth + 2) + '\n';
}

std::string PaperLine(std::size_t name_width) {
    std::string line = "published" + std::string(name_width - 9, ' ');
    for (const PaperFigure& figure : kPaperFigures) {
        line += Padded(Formatted("%.4f", figure.value), kCellWidth);
    }
    return line + "  " + Formatted("%.3f", kPaperStitchingBestPx) + " to " +
           Formatted("%.3f", kPaperStitchingWorstPx) + '\n';
}

}  // namespace

hal::Checked<Summary> Summarise(const std::vector<std::string>& files) {
    std::vector<Row> rows;
    for (const std::string& path : files) {
        const auto figures = Read(path);
        if (!figures) return figures.error();
        AppendRows(path, figures.value(), rows);
    }
    rows.push_back(MeanOf(rows));
    std::size_t name_width = std::string("published").size();
    for (const Row& row : rows) name_width = std::max(name_width, row.name.size());
    std::string table = Head(name_width);
    for (const Row& row : rows) table += Line(row, name_width);
    return Summary{table + PaperLine(name_width)};
}

}  // namespace hitchview::app
