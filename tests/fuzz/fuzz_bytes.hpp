#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace hitchview::tests {

/// Takes the values that a fuzz target needs off its input. What is not there any more is zero.
class FuzzBytes {
 public:
    explicit FuzzBytes(std::span<const std::uint8_t> rest) : rest_(rest) {}

    [[nodiscard]] bool empty() const { return rest_.empty(); }

    template <typename Int>
    Int Take() {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < sizeof(Int); ++i) {
            value = value << 8 | (rest_.empty() ? 0U : rest_.front());
            rest_ = rest_.subspan(std::min<std::size_t>(1, rest_.size()));
        }
        return static_cast<Int>(value);
    }

    /// In [min, max], of two bytes.
    int TakeIn(int min, int max) { return min + Take<std::uint16_t>() % (max - min + 1); }
    /// In [min, max], of four bytes; both ends among them.
    double TakeIn(double min, double max) {
        return std::min(max, min + (max - min) * Take<std::uint32_t>() / UINT32_MAX);
    }
    bool TakeFlag() { return (Take<std::uint8_t>() & 1) != 0; }

    std::span<const std::uint8_t> TakeBytes(std::size_t count) {
        const auto taken = rest_.first(std::min(count, rest_.size()));
        rest_ = rest_.subspan(taken.size());
        return taken;
    }
    [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }

 private:
    std::span<const std::uint8_t> rest_;
};

inline std::string_view TextOf(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace hitchview::tests
