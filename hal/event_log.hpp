#pragma once

#include "hal/event.hpp"

namespace hitchview::hal {

/// The log of this machine, for who looks at it later. Nothing here waits or fails, and no memory
/// is taken. Any thread.
class EventLog {
 public:
    virtual ~EventLog() = default;

    void Add(const Event& event) { DoAdd(event); }

    /// What this program writes to stderr stands in the same log: what is added need not be
    /// written.
    [[nodiscard]] bool has_stderr() const { return DoHasStderr(); }

 private:
    virtual void DoAdd(const Event& event) = 0;
    [[nodiscard]] virtual bool DoHasStderr() const = 0;
};

}  // namespace hitchview::hal
