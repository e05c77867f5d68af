#pragma once

namespace hitchview::hal {

/// Tells the service manager that pictures are being made. Thread: pipeline.
class Watchdog {
 public:
    virtual ~Watchdog() = default;

    /// Once, after the first panorama was handed over.
    void Ready() { DoReady(); }
    /// After each panorama that was handed over; never from a timer.
    void Feed() { DoFeed(); }

 private:
    virtual void DoReady() = 0;
    virtual void DoFeed() = 0;
};

}  // namespace hitchview::hal
