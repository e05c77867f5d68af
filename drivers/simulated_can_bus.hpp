#pragma once

#include "drivers/simulated_rig.hpp"
#include "hal/can_bus.hpp"

namespace hitchview::drivers {

/// The vehicle's bus in the simulated rig: the hitch angle every 20 ms of the drive, laid out as
/// trucks of Ford's trailer assistance send it. It does not pace. kEndOfStream after the last frame
/// of the drive.
class SimulatedCanBus final : public hal::CanBus {
 public:
    /// DBC: 23|12@0+ (0.1,-90), degrees, 8 bytes.
    static constexpr std::uint32_t kHitchAngleId = 1111;
    static constexpr std::chrono::milliseconds kPeriod{20};

    /// `rig` must outlive the bus. Frame i is received at `start` + i periods of 20 ms.
    SimulatedCanBus(const SimulatedRig& rig, hal::Instant start);

 private:
    hal::Result<hal::CanFrame> DoWaitFrame(std::chrono::milliseconds timeout) override;

    const SimulatedRig& rig_;
    hal::Instant start_;
    hal::Instant next_{};  // since the start
};

}  // namespace hitchview::drivers
