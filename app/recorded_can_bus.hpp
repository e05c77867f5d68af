#pragma once

#include <chrono>
#include <thread>

#include "app/record_intake.hpp"
#include "hal/can_bus.hpp"

namespace hitchview::app {

/// A bus whose frames are recorded as they come.
class RecordedCanBus final : public hal::CanBus {
 public:
    /// Both must outlive it. `live`: its moments are those of the clock, not of a recording.
    RecordedCanBus(hal::CanBus& bus, bool live, RecordIntake& intake)
        : bus_(bus), live_(live), intake_(intake) {}

 private:
    hal::Result<hal::CanFrame> DoWaitFrame(std::chrono::milliseconds timeout) override {
        // A recording is not read before its frames are.
        if (!live_ && !intake_.started()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            return hal::Error::kTimeout;
        }
        auto frame = bus_.WaitFrame(timeout);
        if (frame) intake_.Put(frame.value(), live_ ? hal::Instant{} : intake_.origin());
        return frame;
    }
    [[nodiscard]] hal::CanCounts DoCounts() const override { return bus_.counts(); }

    hal::CanBus& bus_;
    bool live_;
    RecordIntake& intake_;
};

}  // namespace hitchview::app
