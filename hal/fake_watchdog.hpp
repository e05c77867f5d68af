#pragma once

#include <atomic>

#include "hal/watchdog.hpp"

namespace hitchview::hal {

/// Counts. Any thread may read.
class FakeWatchdog final : public Watchdog {
 public:
    std::atomic<int> readies{0};
    std::atomic<int> feeds{0};

 private:
    void DoReady() override { ++readies; }
    void DoFeed() override { ++feeds; }
};

}  // namespace hitchview::hal
