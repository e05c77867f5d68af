#pragma once

#include <atomic>

#include "hal/watchdog.hpp"

namespace hitchview::hal {

/// Counts. Any thread may read.
class FakeWatchdog final : public Watchdog {
 public:
    std::atomic<int> readies{0};
    std::atomic<int> feeds{0};
    std::atomic<int> shown{0};
    std::atomic<int> stops{0};

 private:
    void DoReady() override { ++readies; }
    void DoFeed() override { ++feeds; }
    void DoShow(const Health& /*health*/) override { ++shown; }
    void DoStop() override { ++stops; }
};

}  // namespace hitchview::hal
