#include "app/calib_report_graph.hpp"

#include <algorithm>
#include <map>

#include "app/calib_report_json.hpp"
#include "app/calib_report_svg.hpp"

namespace hitchview::app {
namespace {

using nlohmann::json;

constexpr double kWidth = 960;
constexpr double kRow = 34;
constexpr double kLeft = 300;
constexpr double kRight = 660;

/// All sightings of one target by one camera.
struct Edge {
    int sightings = 0;
    double worst_px = 0;
    bool outlier = false;
};

struct Graph {
    std::map<std::string, double> cameras{};  ///< name to row
    std::map<std::string, double> targets{};
    std::map<std::pair<std::string, std::string>, Edge> edges{};
};

void NumberRows(std::map<std::string, double>& nodes, std::size_t most) {
    double row = 0.5 + static_cast<double>(most - nodes.size()) / 2;
    for (auto& [name, at] : nodes) at = row++;
}

Graph GraphOf(const json& sightings) {
    Graph graph;
    if (!sightings.is_array()) return graph;
    for (const json& sighting : sightings) {
        const std::string camera = TextIn(sighting, "camera");
        const std::string target = TextIn(sighting, "target");
        if (camera.empty() || target.empty()) continue;
        graph.cameras[camera] = graph.targets[target] = 0;
        Edge& edge = graph.edges[{camera, target}];
        ++edge.sightings;
        edge.worst_px = std::max(edge.worst_px, NumberIn(sighting, "rms_px").value_or(0));
        edge.outlier |= Part(sighting, "outlier") == true;
    }
    const std::size_t most = std::max(graph.cameras.size(), graph.targets.size());
    NumberRows(graph.cameras, most);
    NumberRows(graph.targets, most);
    return graph;
}

std::string EdgeTable(const Graph& graph) {
    std::string rows;
    for (const auto& [ends, edge] : graph.edges) {
        rows += HtmlRow({ends.first, ends.second, std::to_string(edge.sightings),
                         Short(edge.worst_px, 3), edge.outlier ? "does not fit" : ""});
    }
    return HtmlTable("Sightings", {"camera", "target", "sightings", "worst rms px", ""}, rows);
}

}  // namespace

std::string SightingGraph(const json& sightings) {
    const Graph graph = GraphOf(sightings);
    if (graph.edges.empty()) return kNotInFile;
    std::string svg;
    for (const auto& [ends, edge] : graph.edges) {
        svg += SvgLine(kLeft, kRow * graph.cameras.at(ends.first), kRight,
                       kRow * graph.targets.at(ends.second), edge.outlier ? "edge poor" : "edge");
    }
    for (const auto& [name, row] : graph.cameras)
        svg +=
            SvgDot(kLeft, kRow * row, 5, "node") + SvgText(kLeft - 12, kRow * row + 4, "end", name);
    for (const auto& [name, row] : graph.targets)
        svg += SvgDot(kRight, kRow * row, 5, "node") +
               SvgText(kRight + 12, kRow * row + 4, "start", name);
    const double rows = static_cast<double>(std::max(graph.cameras.size(), graph.targets.size()));
    return "<figure class=\"map\">" + Svg(kWidth, kRow * rows, "Cameras and targets", svg) +
           "<figcaption>Cameras (left) and the targets that they saw. Dashed: does not fit."
           "</figcaption></figure>" +
           EdgeTable(graph);
}

}  // namespace hitchview::app
