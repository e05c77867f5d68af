#include "app/bench_table.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace hitchview::app {
namespace {

using nlohmann::json;

template <typename... Values>
std::string Line(const char* format, Values... values) {
    char text[160];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

double At(const json& figures, const char* key) {
    return figures.at(key).get<double>();
}

std::string WholeFrame(const json& whole) {
    return Line("CPU of a frame set, all threads, without JPEG  %7.1f ms  %5.1f memcpy\n",
                At(whole, "core_ms_without_jpeg"), At(whole, "memcpy_ratio")) +
           Line("CPU of JPEG and publishing                     %7.1f ms  %7.0f bytes\n",
                At(whole, "jpeg_ms"), At(whole, "jpeg_bytes")) +
           Line("from one panorama to the next, as fast as it goes %4.1f ms\n",
                At(whole, "interval_ms")) +
           Line("last tenth of the frame sets to the first, CPU      %5.2f\n",
                At(whole, "growth")) +
           Line("captured to published at 30 Hz: p50 %5.1f ms, p99 %5.1f ms, %d dropped\n",
                At(whole, "p50_ms"), At(whole, "p99_ms"), whole.at("dropped").get<int>()) +
           Line("rendering alone, one thread: %.2f of cv::remap\n",
                At(whole, "render_to_remap_ratio"));
}

/// Empty where nothing was recorded.
std::string Recording(const json& whole) {
    if (!whole.contains("recorded_frames")) return "";
    return Line(
               "while it records: p50 %5.1f ms, p99 %5.1f ms, %d dropped; %d and %d without longer "
               "than a period\n",
               At(whole, "recording_p50_ms"), At(whole, "recording_p99_ms"),
               whole.at("recording_dropped").get<int>(),
               whole.at("recording_deadline_misses").get<int>(),
               whole.at("deadline_misses").get<int>()) +
           Line("recorded %.0f camera frames, %.0f left out; %.1f MB\n",
                At(whole, "recorded_frames"), At(whole, "unrecorded_frames"),
                At(whole, "recorded_bytes") / 1e6);
}

std::string Stages(const json& stages) {
    std::string table = "\nstage, one thread         p50 ms   memcpy\n";
    for (const auto& [name, stage] : stages.items()) {
        table += Line("%-22s %9.2f %8.2f\n", name.c_str(), At(stage, "p50_ms"),
                      At(stage, "memcpy_ratio"));
    }
    return table;
}

std::string Memory(const json& memory) {
    std::string table = "\nmemory, taken at the start     MiB\n";
    for (const auto& [name, bytes] : memory.items())
        table += Line("%-26s %8.1f\n", name.c_str(), bytes.get<double>() / (1 << 20));
    return table;
}

std::string Scaling(const json& scaling) {
    std::string table = "\ncameras canvas workers  core ms  interval ms\n";
    for (const json& row : scaling) {
        table += Line("%7d %6d %7d %8.1f %12.1f\n", row.at("cameras").get<int>(),
                      row.at("canvas_width_px").get<int>(), row.at("workers").get<int>(),
                      At(row, "core_ms_without_jpeg"), At(row, "interval_ms"));
    }
    return table;
}

}  // namespace

std::string BenchTable(const json& figures) {
    std::string table = WholeFrame(figures.at("whole_frame")) +
                        Recording(figures.at("whole_frame")) + Stages(figures.at("stages"));
    table += Memory(figures.at("memory_bytes"));
    if (!figures.at("scaling").empty()) table += Scaling(figures.at("scaling"));
    return table;
}

}  // namespace hitchview::app
