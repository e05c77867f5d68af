#pragma once

#include <array>
#include <atomic>

namespace hitchview::hal {

/// Hands the newest T from one thread to another without waiting. Three slots: one is written,
/// one is read, one lies between. Writer thread: writable, Publish. Reader thread: Take, readable.
template <typename T>
class Mailbox {
 public:
    T& writable() { return slots_[write_]; }
    void Publish() { write_ = Slot(between_.exchange(write_ | kFresh, std::memory_order_acq_rel)); }

    /// False if nothing new was published since the last Take.
    bool Take() {
        if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
        read_ = Slot(between_.exchange(read_, std::memory_order_acq_rel));
        return true;
    }
    T& readable() { return slots_[read_]; }

 private:
    static constexpr unsigned kFresh = 4;
    static unsigned Slot(unsigned value) { return value & 3U; }

    std::array<T, 3> slots_{};
    std::atomic<unsigned> between_{1};
    unsigned write_ = 0;
    unsigned read_ = 2;
};

}  // namespace hitchview::hal
