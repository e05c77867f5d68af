#pragma once

#include <deque>
#include <utility>

#include "hal/can_bus.hpp"

namespace hitchview::hal {

/// Plays a script, one step per WaitFrame, then kEndOfStream.
class FakeCanBus final : public CanBus {
 public:
    explicit FakeCanBus(std::deque<Result<CanFrame>> script) : script_(std::move(script)) {}

 private:
    Result<CanFrame> DoWaitFrame(std::chrono::milliseconds /*timeout*/) override {
        if (script_.empty()) return Error::kEndOfStream;
        const Result<CanFrame> step = script_.front();
        script_.pop_front();
        return step;
    }

    std::deque<Result<CanFrame>> script_;
};

}  // namespace hitchview::hal
