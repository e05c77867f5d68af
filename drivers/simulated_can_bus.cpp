#include "drivers/simulated_can_bus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
    : rig_(rig), start_(start) {}

hal::Result<hal::CanFrame> SimulatedCanBus::DoWaitFrame(std::chrono::milliseconds /*timeout*/) {
    if (next_ > FrameTime(rig_.options(), rig_.options().frames - 1))
        return hal::Error::kEndOfStream;
    const std::uint32_t raw = RawOf(rig_.HitchAngleAt(next_));
    hal::CanFrame frame{.id = kHitchAngleId, .size_bytes = 8, .received_at = start_ + next_};
    frame.data[2] =
        static_cast<std::uint8_t>(raw >> 4);  // bit 23 is the first of 12, Motorola order
    frame.data[3] = static_cast<std::uint8_t>((raw & 15U) << 4);
    next_ += kPeriod;
    return frame;
}

}  // namespace hitchview::drivers
