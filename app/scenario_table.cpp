#include "app/scenario_table.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace hitchview::app {
namespace {

using nlohmann::json;

struct Column {
    const char* title;
    const char* pointer;  ///< into the scenario's figures
    int width;
    int decimals;
};

constexpr std::array kColumns{
    Column{"trac%", "/motion/tractor/left_percent", 6, 1},
    Column{"trail%", "/motion/trailer/left_percent", 6, 1},
    Column{"far.50", "/strip/locked/both/beyond_10_m/median_px", 6, 1},
    Column{"far.95", "/strip/locked/both/beyond_10_m/p95_px", 6, 1},
    Column{"far*.50", "/strip/all_frames/both/beyond_10_m/median_px", 7, 1},
    Column{"far*.95", "/strip/all_frames/both/beyond_10_m/p95_px", 7, 1},
    Column{"near.50", "/strip/locked/both/4_to_10_m/median_px", 7, 1},
    Column{"near.95", "/strip/locked/both/4_to_10_m/p95_px", 7, 1},
    Column{"ovl.50", "/overlap/all_frames/both/all/median_px", 6, 1},
    Column{"orac.50", "/overlap/oracle_all_frames/both/all/median_px", 7, 1},
    Column{"ratio", "/overlap/ratio_all_frames", 6, 2},
    Column{"theta", "/articulation/rms_deg", 5, 2},
    Column{"foldA", "/warp/tractor/folded_cells", 6, 0},
    Column{"foldB", "/warp/trailer/folded_cells", 6, 0},
    Column{"cellA", "/warp/tractor/least_cell_ratio", 5, 3},
    Column{"cellB", "/warp/trailer/least_cell_ratio", 5, 3},
    Column{"viewA", "/warp/tractor/least_view_ratio", 5, 3},
    Column{"viewB", "/warp/trailer/least_view_ratio", 5, 3},
    Column{"cov%", "/coverage/least_percent_of_hinged", 5, 1},
    Column{"lockL%", "/seam/left/locked_percent", 6, 1},
    Column{"lockR%", "/seam/right/locked_percent", 6, 1},
    Column{"waitL", "/seam/left/longest_wait_s", 5, 1},
    Column{"waitR", "/seam/right/longest_wait_s", 5, 1},
    Column{"jumpL", "/seam/left/largest_field_jump_px", 5, 1},
    Column{"jumpR", "/seam/right/largest_field_jump_px", 5, 1},
    Column{"folds", "/safety/folded_cells", 6, 0},
    Column{"bound", "/safety/largest_offset_share", 5, 2},
    Column{"leap", "/safety/largest_locked_jump_px", 5, 1},
    Column{"stale", "/safety/stale_bytes", 5, 0},
    Column{"ms", "/stage_p50_ms/total", 5, 1},
};

std::string Cell(const json& figures, const Column& column) {
    const json::json_pointer at(column.pointer);
    const json value = figures.contains(at) ? figures.at(at) : json();
    char text[32];
    if (value.is_number()) {
        std::snprintf(text, sizeof text, " %*.*f", column.width, column.decimals,
                      value.get<double>());
    } else {
        std::snprintf(text, sizeof text, " %*s", column.width, "-");
    }
    return text;
}

std::string Name(const std::string& name) {
    char text[64];
    std::snprintf(text, sizeof text, "%-20s", name.c_str());
    return text;
}

}  // namespace

std::string ScenarioHead() {
    std::string head =
        "NAME: lookahead 0. NAME+N: N frames are seen ahead. NAME+all: the paper's form, all "
        "are.\ntrac/trail: motion left, 1 to 15 Hz. far: strip misalignment beyond 10 m, px, "
        "median and "
        "p95,\nlocked (*: all frames); near: 4 to 10 m. ovl, orac: whole overlap and oracle, px. "
        "theta: deg.\nfold: cells, A tractor, B trailer. cell, view: least stretch ratio. cov: of "
        "what geometry allows.\nwait: longest, s. jump: of the field, px. folds: cells as drawn. "
        "bound: "
        "largest share of an offset's bound.\nleap: of a locked seam beside the true motion, px. "
        "stale: bytes that depend on earlier pictures. ms: a frame set, median.\n" +
        Name("scenario");
    for (const Column& column : kColumns) {
        char text[32];
        std::snprintf(text, sizeof text, " %*s", column.width, column.title);
        head += text;
    }
    return head + '\n';
}

std::string ScenarioRow(const std::string& name, const json& figures) {
    std::string row = Name(name);
    for (const Column& column : kColumns) row += Cell(figures, column);
    return row + '\n';
}

}  // namespace hitchview::app
