#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hitchview::hal {

/// Text without the heap, at most kBytes - 1 letters and a final NUL. What is longer is cut.
template <std::size_t kBytes>
class FixedText {
    static_assert(kBytes > 0);

 public:
    FixedText() = default;
    FixedText(std::string_view text) { Append(text); }

    FixedText& Append(std::string_view text) {
        const std::size_t letters = std::min(text.size(), kBytes - 1 - length_);
        std::copy_n(text.data(), letters, letters_.data() + length_);
        length_ += letters;
        letters_[length_] = '\0';
        return *this;
    }
    FixedText& AppendNumber(std::int64_t number) {
        std::array<char, 24> digits{};
        const char* const end =
            std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
        return Append({digits.data(), static_cast<std::size_t>(end - digits.data())});
    }

    [[nodiscard]] std::string_view view() const { return {letters_.data(), length_}; }
    [[nodiscard]] const char* c_str() const { return letters_.data(); }

 private:
    std::array<char, kBytes> letters_{};
    std::size_t length_ = 0;
};

}  // namespace hitchview::hal
