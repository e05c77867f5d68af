#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace hitchview::drivers {

/// What other threads have to say to the one that waits for frames: libcamera's, which fills
/// requests, and those on which leases end. Takes no memory from the heap. Any thread.
class LibcameraMailbox {
 public:
    static constexpr int kSlots = 64;

    struct News {
        std::optional<int> filled{};  ///< the slot of a completed request, in order
        std::uint64_t returned = 0;   ///< slots whose lease has ended, as bits
        bool gone = false;            ///< the camera was unplugged
    };

    /// A slot is filled once, until it is taken: they always fit.
    void NoteFilled(int slot) {
        const std::lock_guard lock(mutex_);
        filled_[(first_ + count_++) % filled_.size()] = slot;
        changed_.notify_one();
    }
    /// False if the slot had been returned before.
    bool NoteReturned(int slot) {
        const std::lock_guard lock(mutex_);
        const std::uint64_t bit = 1ULL << slot;
        const bool fresh = (returned_ & bit) == 0;
        returned_ |= bit;
        changed_.notify_one();
        return fresh;
    }
    void NoteGone() {
        const std::lock_guard lock(mutex_);
        gone_ = true;
        changed_.notify_one();
    }

    /// Waits until there is something, at most `timeout`, and takes it; of filled slots one.
    News Take(std::chrono::nanoseconds timeout) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, timeout, [this] { return gone_ || count_ > 0 || returned_ != 0; });
        News news{{}, std::exchange(returned_, 0), gone_};
        if (count_ == 0) return news;
        news.filled = filled_[first_];
        first_ = (first_ + 1) % filled_.size();
        --count_;
        return news;
    }

    /// Of a stream that has ended; what was returned stays.
    void ForgetStream() {
        const std::lock_guard lock(mutex_);
        count_ = 0;
        gone_ = false;
    }

 private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::array<int, kSlots> filled_{};
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    std::uint64_t returned_ = 0;
    bool gone_ = false;
};

}  // namespace hitchview::drivers
