#pragma once

#include <array>
#include <cstddef>

namespace hitchview::algo {

/// A list that holds at most kCapacity items, in memory of its own. What does not fit is refused.
template <typename T, std::size_t N>
class FixedVector {
 public:
    static constexpr std::size_t kCapacity = N;

    /// False when full.
    bool push_back(const T& item) {
        if (size_ == N) return false;
        items_[size_++] = item;
        return true;
    }
    /// One more item, with what was left there. Requires room.
    T& emplace_back() { return items_[size_++]; }
    void pop_back() { --size_; }
    void clear() { size_ = 0; }
    /// Shortens to the first `size` items.
    void truncate(std::size_t size) { size_ = size < size_ ? size : size_; }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] int count() const { return static_cast<int>(size_); }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] bool full() const { return size_ == N; }
    T& operator[](std::size_t i) { return items_[i]; }
    const T& operator[](std::size_t i) const { return items_[i]; }
    T* begin() { return items_.data(); }
    T* end() { return items_.data() + size_; }
    const T* begin() const { return items_.data(); }
    const T* end() const { return items_.data() + size_; }
    T& back() { return items_[size_ - 1]; }
    [[nodiscard]] T* data() { return items_.data(); }
    [[nodiscard]] const T* data() const { return items_.data(); }

 private:
    std::array<T, N> items_{};
    std::size_t size_ = 0;
};

}  // namespace hitchview::algo
