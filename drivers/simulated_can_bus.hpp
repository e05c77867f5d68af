#pragma once

#include "drivers/simulated_rig.hpp"
#include "hal/can_bus.hpp"
#include "hal/clock.hpp"

namespace hitchview::drivers {

/// How the simulated drive runs that a bus tells of.
struct SimulatedCanOptions {
    hal::Instant start{};  ///< of the drive
    int frames = 0;        ///< its length. >= 1
    /// So many of its first frames, forth and back; 0: the drive as it is. [2, rig's]
    int loop_frames = 0;
    /// Frames come at their moments of this clock, without an end; null: as fast as they are read.
    hal::Clock* clock = nullptr;
};

/// The vehicle's bus in the simulated rig: the hitch angle every 20 ms of the drive, laid out as
/// trucks of Ford's trailer assistance send it. kEndOfStream after the last frame of the drive.
class SimulatedCanBus final : public hal::CanBus {
 public:
    /// DBC: 23|12@0+ (0.1,-90), degrees, 8 bytes.
    static constexpr std::uint32_t kHitchAngleId = 1111;
    static constexpr std::chrono::milliseconds kPeriod{20};

    /// Of the whole drive. `rig` must outlive the bus. Frame i is received at `start` + i periods
    /// of 20 ms.
    SimulatedCanBus(const SimulatedRig& rig, hal::Instant start);
    /// The clock must outlive it, too.
    SimulatedCanBus(const SimulatedRig& rig, const SimulatedCanOptions& options);

 private:
    hal::Result<hal::CanFrame> DoWaitFrame(std::chrono::milliseconds timeout) override;

    [[nodiscard]] bool HasEnded() const;
    [[nodiscard]] double HitchAngle() const;

    const SimulatedRig& rig_;
    const SimulatedCanOptions options_;
    hal::Instant next_{};  // since the start
};

}  // namespace hitchview::drivers
