#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

namespace hitchview::calib {

/// A sentence of at most 400 characters with figures in it, as printf makes it.
template <typename... Values>
std::string Sentence(const char* format, Values... values) {
    char text[401];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

/// With ? in place of line ends and of what else has no letter.
inline std::string OneLine(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7F; }, '?');
    return text;
}

}  // namespace hitchview::calib
