#pragma once

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

}  // namespace hitchview::calib
