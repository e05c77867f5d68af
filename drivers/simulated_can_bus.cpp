#include "drivers/simulated_can_bus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/frame_loop.hpp"

namespace hitchview::drivers {
namespace {

constexpr double kFactor_deg = 0.1;
constexpr double kOffset_deg = -90;
constexpr double kLargestRaw = 0xfff;

std::uint32_t RawOf(double angle_rad) {
    const double angle_deg = angle_rad * 180 / std::numbers::pi;
    const double raw = std::round((angle_deg - kOffset_deg) / kFactor_deg);
    return static_cast<std::uint32_t>(std::clamp(raw, 0.0, kLargestRaw));
}

}  // namespace

SimulatedCanBus::SimulatedCanBus(const SimulatedRig& rig, hal::Instant start)
    : SimulatedCanBus(rig, {.start = start, .frames = rig.options().frames}) {}

SimulatedCanBus::SimulatedCanBus(const SimulatedRig& rig, const SimulatedCanOptions& options)
    : rig_(rig), options_(options) {}

bool SimulatedCanBus::HasEnded() const {
    return options_.clock == nullptr && next_ > FrameTime(rig_.options(), options_.frames - 1);
}

double SimulatedCanBus::HitchAngle() const {
    if (options_.loop_frames == 0) return rig_.HitchAngleAt(next_);
    const hal::Instant turn = FrameTime(rig_.options(), options_.loop_frames - 1);
    return rig_.HitchAngleAt(hal::Instant(ForthAndBack(next_.count(), turn.count())));
}

hal::Result<hal::CanFrame> SimulatedCanBus::DoWaitFrame(std::chrono::milliseconds timeout) {
    if (HasEnded()) return hal::Error::kEndOfStream;
    const hal::Instant moment = options_.start + next_;
    if (options_.clock != nullptr) {
        const hal::Instant end = options_.clock->Now() + timeout;
        options_.clock->SleepUntil(std::min(moment, end));
        if (moment > end) return hal::Error::kTimeout;
    }
    const std::uint32_t raw = RawOf(HitchAngle());
    hal::CanFrame frame{.id = kHitchAngleId, .size_bytes = 8, .received_at = moment};
    frame.data[2] =
        static_cast<std::uint8_t>(raw >> 4);  // bit 23 is the first of 12, Motorola order
    frame.data[3] = static_cast<std::uint8_t>((raw & 15U) << 4);
    next_ += kPeriod;
    return frame;
}

}  // namespace hitchview::drivers
