#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>

#include "app/log_report.hpp"
#include "app/log_time.hpp"
#include "app/text_table.hpp"

namespace hitchview::app {
namespace {

constexpr const char* kUnknown = "-";

std::string Fixed(std::optional<double> value, int decimals) {
    if (!value) return kUnknown;
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, *value);
    return text.data();
}

std::string Degrees(std::optional<double> rad) {
    return Fixed(rad ? std::optional(*rad * 180 / std::numbers::pi) : std::nullopt, 1);
}

std::string Count(std::uint64_t count) {
    return std::to_string(count);
}

/// One figure a line: what, and its value.
void AddLine(const std::string& what, const std::string& value, std::string& text) {
    constexpr std::size_t kColumn = 14;
    std::string start = what;
    start.resize(std::max(what.size() + 2, kColumn), ' ');
    text += start + Printable(value) + '\n';
}

std::string Recording(const LogFigures& figures) {
    std::string text;
    AddLine("recording",
            UtcText(figures.first_us) + ", " + Fixed(figures.Duration_s(), 1) + " s, " +
                Count(figures.events) + " events in " + Count(figures.segments) + " files, " +
                Fixed(static_cast<double>(figures.bytes) / 1e6, 1) + " MB",
            text);
    const auto& damage = figures.damage;
    AddLine("damage",
            damage.places == 0 ? "none"
                               : Count(damage.skipped_bytes) + " bytes in " + Count(damage.places) +
                                     " places, " + Count(damage.torn_bytes) + " of them at the end",
            text);
    const std::string step = figures.clock.largest_step_ms
                                 ? ", largest " + Fixed(figures.clock.largest_step_ms, 0) + " ms"
                                 : "";
    AddLine("clock", Count(figures.clock.steps) + " steps" + step, text);
    return text;
}

std::string Cameras(const LogFigures& figures) {
    if (figures.cameras.empty()) return "";
    TextTable table({"camera", "frames", "lost", "gaps", "resets", "time gaps", "longest ms",
                     "period ms", "drift ppm"});
    for (const CameraFigures& camera : figures.cameras)
        table.Add({camera.channel, Count(camera.frames.messages), Count(camera.frames.lost),
                   Count(camera.frames.gaps), Count(camera.frames.resets), Count(camera.time_gaps),
                   Fixed(camera.longest_gap_ms, 1), Fixed(camera.period_ms, 3),
                   Fixed(camera.drift_ppm, 1)},
                  "");
    std::string text = '\n' + table.Text() + '\n';
    const SetFigures& sets = figures.sets;
    AddLine("frame sets",
            Count(sets.sets) + ", complete " + Count(sets.complete) + "; spread p50 " +
                Fixed(sets.p50_ms, 2) + " ms, p99 " + Fixed(sets.p99_ms, 2) + " ms, max " +
                Fixed(sets.max_ms, 2) + " ms",
            text);
    return text;
}

std::string Can(const CanFigures& can) {
    if (can.frames == 0) return "none";
    return Count(can.frames) + " frames, " + Count(can.errors) + " of errors; " + Count(can.gaps) +
           " silences above 1 s, longest " + Fixed(can.longest_gap_ms, 1) + " ms";
}

std::string HitchAngle(const HitchAngleFigures& angle) {
    if (angle.messages.messages == 0) return "none";
    return Degrees(angle.least_rad) + " to " + Degrees(angle.most_rad) + " deg; valid " +
           Count(angle.qualities[0]) + ", not available " + Count(angle.qualities[1]) + ", error " +
           Count(angle.qualities[2]) + ", implausible " + Count(angle.qualities[3]) + ", stale " +
           Count(angle.qualities[4]);
}

std::string Articulation(const ArticulationFigures& figures) {
    if (figures.compared == 0) return "not to be compared";
    return "minus hitch angle: median " + Degrees(figures.median_rad) + " deg, median size " +
           Degrees(figures.median_abs_rad) + " deg, largest " + Degrees(figures.max_abs_rad) +
           " deg, " + Count(figures.compared) + " compared";
}

std::string Panoramas(const PanoramaFigures& figures) {
    const SequenceFigures& status = figures.status;
    if (figures.images.messages + status.messages == 0) return "none";
    return Count(figures.images.messages) + " pictures, " + Count(figures.images.lost) + " lost; " +
           Count(status.messages) + " status, " + Count(status.lost) + " lost in " +
           Count(status.gaps) + " gaps; " + Count(figures.deadline_misses) + " deadlines missed";
}

std::string Vehicle(const LogFigures& figures) {
    std::string text;
    AddLine("CAN", Can(figures.can), text);
    AddLine("hitch angle", HitchAngle(figures.hitch_angle), text);
    AddLine("articulation", Articulation(figures.articulation), text);
    AddLine("panoramas", Panoramas(figures.panoramas), text);
    return text;
}

std::string Events(const LogFigures& figures) {
    std::string text;
    for (const ListedEvent& event : figures.listed_events)
        AddLine("event",
                UtcText(event.utime_us) + " " + std::to_string(event.code) + " " + event.subject +
                    ": " + event.text,
                text);
    const std::uint64_t rest = figures.event_messages.messages - figures.listed_events.size();
    if (rest > 0) AddLine("event", "and " + Count(rest) + " more", text);
    return text;
}

std::string Verdict(const LogVerdict& verdict) {
    std::string text = "\nverdict: " + std::string(verdict.good() ? "good" : "bad") + '\n';
    for (const std::string& reason : verdict.reasons) text += DetailLines("bad", reason);
    for (const std::string& note : verdict.notes) text += DetailLines("note", note);
    return text;
}

}  // namespace

std::string LogTable(const LogFigures& figures, const LogVerdict& verdict) {
    return Recording(figures) + Cameras(figures) + Vehicle(figures) + Events(figures) +
           Verdict(verdict);
}

}  // namespace hitchview::app
