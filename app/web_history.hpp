#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

namespace hitchview::app {

/// The newest few of a row of values, numbered from 1 on, so that each client can be told those
/// that it has not seen. A client that was away for too long misses the oldest.
template <typename T>
class WebHistory {
 public:
    explicit WebHistory(std::size_t capacity) : capacity_(capacity) {}

    void Append(T value) {
        if (values_.size() == capacity_) values_.pop_front();
        values_.push_back(std::move(value));
        ++newest_;
    }

    /// Number of the newest value; 0 without one.
    [[nodiscard]] std::uint64_t newest() const { return newest_; }

    /// Calls `visit(number, value)` for each value behind number `after`, oldest first.
    template <typename Visit>
    void VisitAfter(std::uint64_t after, Visit&& visit) const {
        std::uint64_t number = newest_ - values_.size();
        for (const T& value : values_) {
            if (++number > after) visit(number, value);
        }
    }

 private:
    std::size_t capacity_;
    std::deque<T> values_{};
    std::uint64_t newest_ = 0;
};

}  // namespace hitchview::app
