#include "app/log_verdict.hpp"

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace hitchview::app {
namespace {

using Lines = std::vector<std::string>;

[[gnu::format(printf, 1, 2)]] std::string Text(const char* format, ...) {
    std::array<char, 256> text{};
    std::va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text.data(), text.size(), format, arguments);
    va_end(arguments);
    return text.data();
}

double Share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

double LostShare(const SequenceFigures& figures) {
    return Share(figures.lost, figures.lost + figures.messages);
}

unsigned long long Number(std::uint64_t number) {
    return number;
}

void JudgeDamage(const LogFigures& figures, Lines& reasons) {
    const drivers::LcmLogDamage& damage = figures.damage;
    if (damage.places > 0)
        reasons.push_back(
            Text("damaged: %llu bytes in %llu places are in no event, at least %llu "
                 "events are lost%s",
                 Number(damage.skipped_bytes), Number(damage.places), Number(damage.lost_events),
                 damage.torn_bytes > 0 ? ", the end is torn" : ""));
    if (figures.undecodable > 0)
        reasons.push_back(
            Text("%llu messages are not what their channel holds", Number(figures.undecodable)));
}

void JudgeCamera(const CameraFigures& camera, const LogLimits& limits, Lines& reasons) {
    const char* const name = camera.channel.c_str();
    if (camera.frames.messages == 0) return reasons.push_back(Text("%s has no frame", name));
    if (LostShare(camera.frames) > limits.lost_share)
        reasons.push_back(Text("%s lost %llu frames of %llu in %llu places (%.2f %%)", name,
                               Number(camera.frames.lost),
                               Number(camera.frames.lost + camera.frames.messages),
                               Number(camera.frames.gaps), 100 * LostShare(camera.frames)));
    const double gap_share = Share(camera.time_gaps, camera.frames.messages);
    if (camera.frames.lost == 0 && gap_share > limits.lost_share)
        reasons.push_back(Text("%s has %llu gaps of more than 1.5 periods, the longest %.0f ms",
                               name, Number(camera.time_gaps), camera.longest_gap_ms.value_or(0)));
    if (std::abs(camera.drift_ppm.value_or(0)) > limits.drift_ppm)
        reasons.push_back(Text("%s drifts by %.0f ppm", name, *camera.drift_ppm));
}

void JudgeSets(const LogFigures& figures, const LogLimits& limits, Lines& reasons) {
    const SetFigures& sets = figures.sets;
    const double incomplete = 1 - Share(sets.complete, sets.sets);
    if (sets.sets > 0 && incomplete > limits.incomplete_share)
        reasons.push_back(
            Text("%.1f %% of the frame sets lack a camera's frame", 100 * incomplete));
    if (sets.p99_ms.value_or(0) > limits.spread_periods * figures.period_ms)
        reasons.push_back(
            Text("frame sets are spread over %.1f ms (99 of 100), half a period is "
                 "%.1f ms: the cameras are not synchronised",
                 *sets.p99_ms, figures.period_ms / 2));
}

void JudgeRest(const LogFigures& figures, const LogLimits& limits, Lines& reasons) {
    if (figures.can.gaps > 0)
        reasons.push_back(
            Text("the CAN bus was silent %llu times for more than a second, the "
                 "longest %.1f s",
                 Number(figures.can.gaps), figures.can.longest_gap_ms.value_or(0) / 1e3));
    const SequenceFigures& status = figures.panoramas.status;
    if (LostShare(status) > limits.lost_panorama_share)
        reasons.push_back(Text("%llu of %llu panoramas are missing (%.1f %%)", Number(status.lost),
                               Number(status.lost + status.messages), 100 * LostShare(status)));
    if (figures.cameras.empty() && figures.panoramas.images.messages == 0 &&
        figures.can.frames == 0)
        reasons.emplace_back("no camera's frame, no panorama and no CAN frame is in it");
}

void Note(const LogFigures& figures, Lines& notes) {
    const ClockFigures& clock = figures.clock;
    if (clock.steps > 0)
        notes.push_back(Text("the wall clock stepped %llu times, by up to %.0f ms",
                             Number(clock.steps), clock.largest_step_ms.value_or(0)));
    if (clock.log_steps_back > 0)
        notes.push_back(
            Text("the times of the log go back %llu times", Number(clock.log_steps_back)));
    if (!figures.has_rig) notes.emplace_back("no RIG: it cannot be replayed without a rig file");
    for (const CameraFigures& camera : figures.cameras)
        if (camera.frames.resets > 0)
            notes.push_back(Text("%s began its numbers anew %llu times", camera.channel.c_str(),
                                 Number(camera.frames.resets)));
}

}  // namespace

LogVerdict Judge(const LogFigures& figures, const LogLimits& limits) {
    LogVerdict verdict;
    JudgeDamage(figures, verdict.reasons);
    for (const CameraFigures& camera : figures.cameras)
        JudgeCamera(camera, limits, verdict.reasons);
    JudgeSets(figures, limits, verdict.reasons);
    JudgeRest(figures, limits, verdict.reasons);
    Note(figures, verdict.notes);
    return verdict;
}

}  // namespace hitchview::app
