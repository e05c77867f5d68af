#include "drivers/frame_slot.hpp"

#include <thread>

namespace hitchview::drivers {

std::optional<hal::FramePool::Slot> WaitSlot(hal::FramePool& pool,
                                             std::chrono::milliseconds timeout) {
    constexpr std::chrono::milliseconds kRetry{1};
    for (auto left = timeout;; left -= kRetry) {
        if (auto maybe_slot = pool.Take()) return maybe_slot;
        if (left <= std::chrono::milliseconds::zero()) return std::nullopt;
        std::this_thread::sleep_for(kRetry);
    }
}

}  // namespace hitchview::drivers
