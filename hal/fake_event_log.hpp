#pragma once

#include <mutex>
#include <vector>

#include "hal/event_log.hpp"

namespace hitchview::hal {

/// Keeps what it was given.
class FakeEventLog final : public EventLog {
 public:
    explicit FakeEventLog(bool has_stderr) : has_stderr_(has_stderr) {}

    /// Any thread.
    [[nodiscard]] std::vector<Event> events() const {
        const std::lock_guard lock(mutex_);
        return events_;
    }

 private:
    void DoAdd(const Event& event) override {
        const std::lock_guard lock(mutex_);
        events_.push_back(event);
    }
    [[nodiscard]] bool DoHasStderr() const override { return has_stderr_; }

    const bool has_stderr_;
    mutable std::mutex mutex_;
    std::vector<Event> events_;
};

}  // namespace hitchview::hal
