#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

namespace hitchview::hal {

/// Bounded queue whose faster side waits for the slower one. For files, where nothing may be lost
/// and nothing is late; live frames go through a Mailbox. Takes no memory. Any thread.
template <typename T, std::size_t kCapacity>
class BlockingRing {
 public:
    /// Waits while full. False, and the item is gone, once closed.
    bool Append(T item) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return closed_ || count_ < kCapacity; });
        if (closed_) return false;
        items_[(first_ + count_++) % kCapacity] = std::move(item);
        changed_.notify_all();
        return true;
    }

    /// Without waiting. False, and the item is gone, while full and once closed.
    bool TryAppend(T item) {
        const std::lock_guard lock(mutex_);
        if (closed_ || count_ == kCapacity) return false;
        items_[(first_ + count_++) % kCapacity] = std::move(item);
        changed_.notify_all();
        return true;
    }

    /// Waits while empty. Empty when closed and all was taken.
    std::optional<T> Take() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return closed_ || count_ > 0; });
        return TakeFirst();
    }

    /// The same with a limit. Empty also when nothing came in time: see finished().
    std::optional<T> TakeFor(std::chrono::milliseconds timeout) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, timeout, [this] { return closed_ || count_ > 0; });
        return TakeFirst();
    }

    /// Nothing more will be appended. What was appended may still be taken.
    void Close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_all();
    }

    /// Closed, and all was taken.
    [[nodiscard]] bool finished() const {
        const std::lock_guard lock(mutex_);
        return closed_ && count_ == 0;
    }

    /// Fewest items that a Take has ever left: for a ring of free slots, how close it came to
    /// running dry. The capacity before the first.
    [[nodiscard]] int low_water() const {
        const std::lock_guard lock(mutex_);
        return static_cast<int>(fewest_);
    }

 private:
    std::optional<T> TakeFirst() {
        if (count_ == 0) return std::nullopt;
        std::optional<T> item(std::move(items_[first_]));
        first_ = (first_ + 1) % kCapacity;
        --count_;
        fewest_ = std::min(fewest_, count_);
        changed_.notify_all();
        return item;
    }

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::array<T, kCapacity> items_{};
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    std::size_t fewest_ = kCapacity;
    bool closed_ = false;
};

}  // namespace hitchview::hal
