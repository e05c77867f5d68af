#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace hitchview::drivers {

/// Takes big-endian values off the front of a message. After the first that is not there, every
/// value is zero or empty and ok() is false. Nothing is copied: texts and bytes borrow the message.
///
/// It stands where the decoders that lcm-gen makes would take memory for whatever length a damaged
/// message names.
class LcmMessageReader {
 public:
    explicit LcmMessageReader(std::span<const std::uint8_t> rest) : rest_(rest) {}

    [[nodiscard]] bool ok() const { return ok_; }
    [[nodiscard]] bool at_end() const { return ok_ && rest_.empty(); }

    template <typename Int>
    Int Take() {
        std::make_unsigned_t<Int> value = 0;
        for (const std::uint8_t byte : TakeBytes(sizeof(Int))) {
            value = static_cast<std::make_unsigned_t<Int>>(value << 8 | byte);
        }
        return static_cast<Int>(value);
    }

    double TakeDouble() { return std::bit_cast<double>(Take<std::int64_t>()); }

    std::span<const std::uint8_t> TakeBytes(std::int64_t count) {
        ok_ = ok_ && count >= 0 && static_cast<std::uint64_t>(count) <= rest_.size();
        if (!ok_) return {};
        const auto taken = rest_.first(static_cast<std::size_t>(count));
        rest_ = rest_.subspan(taken.size());
        return taken;
    }

    std::string_view TakeText(std::int64_t count) {
        const auto bytes = TakeBytes(count);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }

    /// A string of LCM: its length counts the NUL at its end.
    std::string_view TakeString() {
        const std::string_view text = TakeText(Take<std::int32_t>());
        ok_ = ok_ && !text.empty() && text.back() == '\0';
        return ok_ ? text.substr(0, text.size() - 1) : std::string_view{};
    }

 private:
    std::span<const std::uint8_t> rest_;
    bool ok_ = true;
};

}  // namespace hitchview::drivers
