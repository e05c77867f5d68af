#pragma once

#include <charconv>
#include <string_view>

#include "hal/expect.hpp"

namespace hitchview::tests {

inline int LinesOf(std::string_view text) {
    int lines = 1;
    for (const char c : text) lines += c == '\n' ? 1 : 0;
    return lines;
}

/// That each line of an error reads `file:line: text`, or `file: text` where it is about the file
/// as a whole. `lines`: of the file.
inline void ExpectComplaint(std::string_view error, std::string_view file, int lines) {
    HV_EXPECT(!error.empty());
    while (!error.empty()) {
        std::string_view line = error.substr(0, error.find('\n'));
        error.remove_prefix(line.size());
        if (!error.empty()) error.remove_prefix(1);
        HV_EXPECT(line.starts_with(file));
        line.remove_prefix(file.size());
        HV_EXPECT(line.starts_with(':'));
        if (line.starts_with(": ")) continue;
        int number = 0;
        const auto parsed = std::from_chars(line.data() + 1, line.data() + line.size(), number);
        HV_EXPECT(number >= 1 && number <= lines);
        HV_EXPECT(
            line.substr(static_cast<std::size_t>(parsed.ptr - line.data())).starts_with(": "));
    }
}

}  // namespace hitchview::tests
