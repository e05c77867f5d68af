#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "hal/pool_level.hpp"

namespace hitchview::hal {

/// Bounded queue from one thread to another, in order. What does not fit is refused and counted.
/// Writer thread: Append. Reader thread: Take. Any thread: refused, level.
template <typename T, std::size_t kCapacity>
class Ring {
    static_assert(kCapacity > 0 && (kCapacity & (kCapacity - 1)) == 0,
                  "capacity is a power of two");

 public:
    /// False if the ring is full; `item` is then left alone.
    bool Append(T&& item) {
        const std::size_t end = end_.load(std::memory_order_relaxed);
        const std::size_t begin = begin_.load(std::memory_order_acquire);
        if (end - begin == kCapacity) {
            refused_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        items_[end % kCapacity] = std::move(item);
        end_.store(end + 1, std::memory_order_release);
        NoteFree(kCapacity - (end + 1 - begin));
        return true;
    }
    bool Append(const T& item) { return Append(T(item)); }

    /// Empty when there is nothing.
    std::optional<T> Take() {
        const std::size_t begin = begin_.load(std::memory_order_relaxed);
        if (begin == end_.load(std::memory_order_acquire)) return std::nullopt;
        std::optional<T> item(std::move(items_[begin % kCapacity]));
        begin_.store(begin + 1, std::memory_order_release);
        return item;
    }

    [[nodiscard]] std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }
    [[nodiscard]] PoolLevel level() const {
        return {static_cast<int>(kCapacity), static_cast<int>(fewest_free_.load())};
    }

 private:
    // The reader may have taken more meanwhile: at least so many are free. Thread: the writer.
    void NoteFree(std::size_t free) {
        if (free < fewest_free_.load(std::memory_order_relaxed))
            fewest_free_.store(free, std::memory_order_relaxed);
    }

    std::array<T, kCapacity> items_{};
    alignas(64) std::atomic<std::size_t> begin_{0};
    alignas(64) std::atomic<std::size_t> end_{0};
    std::atomic<std::uint64_t> refused_{0};
    std::atomic<std::size_t> fewest_free_{kCapacity};
};

}  // namespace hitchview::hal
