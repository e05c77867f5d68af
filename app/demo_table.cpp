#include "app/demo_table.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace hitchview::app {
namespace {

using nlohmann::json;

struct Row {
    const char* title;
    const char* pointer;  ///< JSON pointer into the figures
};

constexpr std::array kRows{
    Row{"seam error beyond 10 m, median", "/strip/all_frames/both/beyond_10_m/median_px"},
    Row{"seam error beyond 10 m, p95", "/strip/all_frames/both/beyond_10_m/p95_px"},
    Row{"seam error 4 to 10 m, median", "/strip/all_frames/both/4_to_10_m/median_px"},
    Row{"seam error 4 to 10 m, p95", "/strip/all_frames/both/4_to_10_m/p95_px"},
    Row{"articulation error, rms, degrees", "/articulation/rms_deg"}};

std::string Number(const json& figures, const std::string& pointer) {
    const json::json_pointer at(pointer);
    if (!figures.contains(at) || !figures[at].is_number()) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", figures[at].get<double>());
    return text;
}

std::string Line(const std::string& title, const std::string& before, const std::string& after) {
    char text[128];
    std::snprintf(text, sizeof text, "  %-34s %8s %8s\n", title.c_str(), before.c_str(),
                  after.c_str());
    return text;
}

}  // namespace

std::string DemoTable(const json& before, const json& after) {
    std::string table = "against ground truth (canvas px):      before    after\n";
    for (const std::string unit : {"tractor", "trailer"}) {
        const std::string motion = "/motion/" + unit;
        table += Line("shake of the " + unit + ", 1 to 15 Hz", Number(after, motion + "/input_px"),
                      Number(after, motion + "/output_px"));
    }
    for (const Row& row : kRows)
        table += Line(row.title, Number(before, row.pointer), Number(after, row.pointer));
    return table;
}

}  // namespace hitchview::app
