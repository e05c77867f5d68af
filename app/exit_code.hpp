#pragma once

#include <cstdio>
#include <string>

namespace hitchview::app {

// What the programs end with.
inline constexpr int kGood = 0;
inline constexpr int kBad = 1;  ///< it worked, and what it looked at is not good
inline constexpr int kWrongUse = 2;
inline constexpr int kMachineFailed = 3;  ///< a file, a device or the network did not do its part

/// Tells why on stderr; the code.
inline int Fail(int code, const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    return code;
}

}  // namespace hitchview::app
