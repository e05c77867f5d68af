#include "app/log_streams.hpp"

#include <algorithm>
#include <cmath>

#include "app/evaluation_statistics.hpp"
#include "app/log_time.hpp"

namespace hitchview::app {
namespace {

using hal::Instant;

}  // namespace

void SequenceCounter::Add(std::uint32_t sequence) {
    // A jump that no recording explains is a camera or a program that began anew.
    constexpr std::uint32_t kMostLost = 1'000'000;
    ++figures_.messages;
    step_.reset();
    if (last_) {
        const std::uint32_t step = sequence - *last_;
        const bool goes_on = step >= 1 && step <= kMostLost;
        if (goes_on) step_ = step;
        figures_.lost += goes_on ? step - 1 : 0;
        figures_.gaps += goes_on && step > 1 ? 1 : 0;
        figures_.resets += goes_on ? 0 : 1;
    }
    last_ = sequence;
}

void GapCounter::Add(Instant at) {
    if (last_) {
        const Instant gap = at - *last_;
        longest_ = std::max(longest_.value_or(gap), gap);
        gaps_ += gap > bound_ ? 1 : 0;
    }
    last_ = at;
}

std::optional<double> GapCounter::longest_ms() const {
    return longest_ ? std::optional(Milliseconds(*longest_)) : std::nullopt;
}

void CameraStream::Add(const drivers::LoggedImage& image) {
    const Instant at = image.captured_at.value_or(std::chrono::microseconds(image.utime_us));
    if (image.sequence) {
        sequence_.Add(*image.sequence);
    } else {
        sequence_.AddUnnumbered();
    }
    const std::optional<std::uint32_t> step = image.sequence ? sequence_.step() : 1;
    if (step && !times_.empty()) {
        stepped_time_ += at - times_.back();
        steps_ += *step;
    }
    times_.push_back(at);
}

std::optional<double> CameraStream::Period_ms() const {
    constexpr std::uint64_t kFewest = 10;
    if (steps_ < kFewest || stepped_time_.count() <= 0) return std::nullopt;
    return Milliseconds(stepped_time_) / static_cast<double>(steps_);
}

CameraFigures CameraStream::Figures(double period_ms) const {
    GapCounter gaps(Instant(std::llround(1.5e6 * period_ms)));
    for (const Instant at : times_) gaps.Add(at);
    return {.channel = channel_,
            .frames = sequence_.figures(),
            .time_gaps = period_ms > 0 ? gaps.gaps() : 0,
            .longest_gap_ms = gaps.longest_ms(),
            .period_ms = Period_ms(),
            .drift_ppm = std::nullopt};
}

void ClockOffset::Add(std::int64_t utime_us, Instant monotonic) {
    // Slewing moves a clock by half a millisecond a second at most.
    constexpr double kStep_ms = 10;
    const Instant offset = std::chrono::microseconds(utime_us) - monotonic;
    ++figures_.readings;
    const double step_ms = offset_ ? std::abs(Milliseconds(offset - *offset_)) : 0;
    offset_ = offset;
    if (step_ms <= kStep_ms) return;
    ++figures_.steps;
    figures_.largest_step_ms = std::max(figures_.largest_step_ms.value_or(0), step_ms);
}

void ClockOffset::AddLogTime(std::int64_t utime_us) {
    // A damaged time may be any number: differences of integers could overflow.
    constexpr double kMostDisorder_us = 1e6;
    const bool back = latest_us_ && static_cast<double>(utime_us) <
                                        static_cast<double>(*latest_us_) - kMostDisorder_us;
    if (back) ++figures_.log_steps_back;
    latest_us_ = back ? utime_us : std::max(latest_us_.value_or(utime_us), utime_us);
}

void ArticulationComparison::Add(const hal::HitchAngle& angle) {
    if (angle.quality == hal::HitchAngleQuality::kValid)
        vehicle_.push_back({angle.received_at, angle.angle_rad});
}

void ArticulationComparison::Add(const hal::PanoramaStatus& status) {
    if (std::isfinite(status.articulation_rad))
        images_.push_back({status.captured_from, status.articulation_rad});
}

ArticulationFigures ArticulationComparison::Figures() const {
    constexpr Instant kLongestLine = std::chrono::milliseconds(500);
    std::vector<Angle> vehicle = vehicle_;
    std::ranges::stable_sort(vehicle, {}, &Angle::at);
    std::vector<double> differences;
    std::vector<double> sizes;
    for (const Angle& seen : images_) {
        const auto late = std::ranges::upper_bound(vehicle, seen.at, {}, &Angle::at);
        if (late == vehicle.begin() || late == vehicle.end()) continue;
        const Angle& early = *std::prev(late);
        if (late->at - early.at > kLongestLine) continue;
        const double share = Milliseconds(seen.at - early.at) / Milliseconds(late->at - early.at);
        differences.push_back(seen.rad - std::lerp(early.rad, late->rad, share));
        sizes.push_back(std::abs(differences.back()));
    }
    return {.compared = differences.size(),
            .median_rad = Quantile(differences, 0.5),
            .median_abs_rad = Quantile(sizes, 0.5),
            .max_abs_rad = Largest(sizes)};
}

}  // namespace hitchview::app
