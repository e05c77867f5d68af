#pragma once

#include "hal/health.hpp"

namespace hitchview::hal {

/// Tells the service manager that pictures are being made. Nothing here waits or fails: whoever
/// does not listen is not told. Thread: the publisher's.
class Watchdog {
 public:
    virtual ~Watchdog() = default;

    /// Once, after the first panorama was handed over.
    void Ready() { DoReady(); }
    /// After each panorama that was handed over; never from a timer.
    void Feed() { DoFeed(); }
    /// How the program does, for people: says nothing about whether it lives.
    void Show(const Health& health) { DoShow(health); }
    /// The program ends as it was asked to. Once.
    void Stop() { DoStop(); }

 private:
    virtual void DoReady() = 0;
    virtual void DoFeed() = 0;
    virtual void DoShow(const Health& health) = 0;
    virtual void DoStop() = 0;
};

}  // namespace hitchview::hal
